#pragma once
/// Generates code with a given mix of instructions. Its rate is the best that the processor reaches
/// for the mix if no instruction waits for another.
#include "experiments/measure/ceilings/assembled_loop.hpp"
#include "variants/isa/machine_code.hpp"

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace dss {

/// A loop whose pass executes a mix once. The instructions are independent, evenly interleaved, and
/// work on normal numbers in L1.
class GeneratedMix {
public:
  /// @throws InputError if it cannot be assembled
  GeneratedMix(const InstructionMix& mix, const InstructionSet& isa, bool is_double);
  void run(long passes) const;

private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> memory_;
  AssembledLoop loop_;
};

} // namespace dss
