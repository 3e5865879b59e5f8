#pragma once
/// Packs of lanes for the instruction set that the including module is compiled for. DSS_ISA_PACKS
/// names the header that declares them, variants/isa/NAME/packs.hpp, and DSS_ISA_REGISTERS is the
/// number of registers. The variant's build rule gives both. Without them a pack is a scalar, and
/// there is no fused multiply-add.
#include "kernels/simd/inline.hpp"
#include "kernels/simd/lane_mask.hpp"
#include <cmath>

#ifdef DSS_ISA_PACKS
#include DSS_ISA_PACKS
namespace dss::simd {
inline constexpr int registers = DSS_ISA_REGISTERS;
} // namespace dss::simd
#else
#include "kernels/simd/scalar.hpp"
namespace dss::simd {
inline constexpr bool has_fma = false;
inline constexpr int registers = 16;
} // namespace dss::simd
#endif

DSS_INLINE_BEGIN
namespace dss::simd {

template <class T>
constexpr int lanes = int(sizeof(Pack<T>) / sizeof(T));
template <class T>
constexpr LaneMask all_lanes = LaneMask((1u << lanes<T>)-1);

/// Brings a cache line into L2.
inline void fetch(const char* line) { __builtin_prefetch(line, 0, 2); }

/// Scalar a * b + c: fused exactly where the module's instruction set has FMA (never a call of the
/// C library's software fma).
template <class T>
inline T scalar_fma(T a, T b, T c) {
  if constexpr (has_fma)
    return std::fma(a, b, c);
  else
    return a * b + c;
}
inline double fma(double a, double b, double c) { return scalar_fma(a, b, c); }
inline float fma(float a, float b, float c) { return scalar_fma(a, b, c); }

} // namespace dss::simd
DSS_INLINE_END
