#pragma once
#include <xmmintrin.h>

namespace dss::isa {

#ifdef __FMA__
inline constexpr bool may_use_fma = true;
#else
inline constexpr bool may_use_fma = false;
#endif

/// MXCSR: bit 15 flushes results to zero (FTZ), bit 6 takes operands as zero (DAZ).
using FloatMode = unsigned;
inline constexpr FloatMode flush_bits = 0x8040;
inline FloatMode float_mode() { return _mm_getcsr(); }
inline void set_float_mode(FloatMode mode) { _mm_setcsr(mode); }

/// Tells the core that this thread spins.
inline void pause() { _mm_pause(); }

} // namespace dss::isa
