#pragma once
/// Generates code with a given mix of instructions. Its rate is the best that the processor reaches
/// for the mix if no instruction waits for another.
#include "experiments/measure/ceilings/assembled_loop.hpp"

#include <cstddef>
#include <memory>
#include <string>

namespace dss {

/// Numbers of instructions of a pass: vector arithmetic (scalar in scalar code), loads and stores.
struct InstructionMix {
  double fma = 0; ///< fused multiply-adds
  /// Sums include differences, and products include quotients. Some processors have separate units
  /// for each.
  double sums = 0, products = 0;
  double shuffles = 0; ///< moves of lanes
  double loads = 0;    ///< operands in memory and separate load instructions
  double stores = 0;
  /// The part of loads and stores that is on the stack, because there were too few registers.
  double stack_loads = 0, stack_stores = 0;
  double rest = 0; ///< moves, addresses, counters, branches
};

/// Registers and name suffix of an instruction set and a precision.
struct VectorNames {
  std::string reg, suffix; ///< zmm, ymm, xmm; pd, ps, sd, ss
  int bytes;               ///< of a register, or of a scalar
  int registers;
  bool is_scalar;
};
/// @param isa  scalar, avx2, avx512
/// @param precision  f64, f32
VectorNames vector_names(const std::string& isa, const std::string& precision);

/// A loop whose pass executes a mix once. The instructions are independent, evenly interleaved, and
/// work on normal numbers in L1.
class GeneratedMix {
public:
  /// @throws InputError if it cannot be assembled
  GeneratedMix(const InstructionMix& mix, const std::string& isa, const std::string& precision);
  void run(long passes) const;

private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> memory_;
  AssembledLoop loop_;
};

} // namespace dss
