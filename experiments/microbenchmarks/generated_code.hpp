#pragma once
/// Code with a given mix of instructions: what the processor gives for a kernel's mix where nothing waits for anything.
#include "experiments/microbenchmarks/assembled_loop.hpp"

#include <cstddef>
#include <memory>
#include <string>

namespace dss {

/// Instructions of a pass: vector (or, in scalar code, scalar) arithmetic, and operands in memory.
struct InstructionMix {
  double fma = 0;                ///< fused multiply-adds
  double sums = 0, products = 0; ///< and differences; and quotients: some processors have units of their own for each
  double shuffles = 0;           ///< of lanes
  double loads = 0;              ///< from memory, as an operand or by themselves
  double stores = 0;
  double stack_loads = 0, stack_stores = 0; ///< of these, the stack's: registers that did not suffice
  double rest = 0;                          ///< moves, addresses, counters, branches
};

/// The registers and names of an instruction set and a precision.
struct VectorNames {
  std::string reg, suffix; ///< zmm, ymm, xmm; pd, ps, sd, ss
  int bytes;               ///< of a register, or of a scalar
  int registers;
  bool is_scalar;
};
/// @param isa  scalar, avx2, avx512  @param precision  f64, f32
VectorNames vector_names(const std::string& isa, const std::string& precision);

/// A loop whose passes make all of a mix, of independent instructions on ordinary numbers in L1, evenly interleaved.
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
