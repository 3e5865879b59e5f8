#pragma once
#include <cstdint>

namespace dss::isa {

/// Every processor of this architecture has it.
inline constexpr bool may_use_fma = true;

/// FPCR: bit 24 takes operands as zero and flushes results to zero (FZ).
using FloatMode = std::uint64_t;
inline constexpr FloatMode flush_bits = FloatMode(1) << 24;
inline FloatMode float_mode() {
  FloatMode mode;
  asm volatile("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
inline void set_float_mode(FloatMode mode) { asm volatile("msr fpcr, %0" : : "r"(mode)); }

/// Tells the core that this thread spins.
inline void pause() { asm volatile("yield"); }

} // namespace dss::isa
