#pragma once
/// Packs of one lane. -march= decides whether there is a fused multiply-add.
#include "kernels/simd/scalar.hpp"
#include "variants/isa/architecture.hpp"

namespace dss::simd {

inline constexpr bool has_fma = isa::may_use_fma;

} // namespace dss::simd
