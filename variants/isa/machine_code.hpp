#pragma once
/// What the program reads and writes in the language of the processor: lines of assembly and of
/// disassembly. Each architecture's folder defines these functions. x86 alone has the loops and the
/// counting; elsewhere they throw InputError with that reason.
#include "variants/isa/instruction_mix.hpp"
#include "variants/isa/instruction_set.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <sys/types.h>

namespace dss {

/// Layout of a page of memory in cache lines: constants, then loaded values, then stored values. No
/// load has the low address bits of a store: the processor would suspect that the two overlap.
struct MixPage {
  static constexpr int line = 64, constants = 4, load_lines = 24, first_store_line = 32,
                       store_lines = 24, bytes = 4096;
  /// What the constant lines hold: x = factor x + term, x + small_term; then a start for x.
  static constexpr double factor = 0.98, term = 0.1, small_term = 0.013, start = 0.5;
};

/// Body of a function loop(in, out, count) (AssembledLoop) whose pass executes a mix once. `in` is
/// a MixPage, `out` the first stored line of another. The instructions are independent and evenly
/// interleaved.
std::string mix_loop(const InstructionMix& mix, const InstructionSet& isa, bool is_double);

/// Body of such a function that streams doubles. A turn moves four packs.
/// @param kind  load, copy or triad
/// @param bytes  all memory; a triad reads three streams, each a quarter of it
std::string stream_loop(const std::string& kind, const InstructionSet& isa, std::size_t bytes);

/// Adds an instruction that was executed `count` times.
/// @param text  as objdump prints it, such as "vaddpd 0x40(%rsp),%zmm1,%zmm2"
void count_instruction(const std::string& text, double count, InstructionMix& mix);

/// Address of the next instruction of a stopped process that this one traces.
std::uint64_t program_counter(pid_t process);

} // namespace dss
