#include "variants/isa/machine_code.hpp"
#include "solver/error.hpp"

namespace dss {

[[noreturn]] static void refuse() {
  throw InputError("assembled loops and instruction mixes exist for x86 processors only");
}

std::string mix_loop(const InstructionMix&, const InstructionSet&, bool) { refuse(); }
std::string stream_loop(const std::string&, const InstructionSet&, std::size_t) { refuse(); }
void count_instruction(const std::string&, double, InstructionMix&) { refuse(); }
std::uint64_t program_counter(pid_t) { refuse(); }

} // namespace dss
