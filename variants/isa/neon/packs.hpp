#pragma once
/// Packs of NEON (Advanced SIMD of aarch64): 2 doubles or 4 floats. Not over xsimd: version 8.1
/// (Debian 12) divides floats by estimates, which round differently.
#include "kernels/simd/inline.hpp"
#include "kernels/simd/lane_mask.hpp"
#include <arm_neon.h>

DSS_INLINE_BEGIN
namespace dss::simd {

inline constexpr bool has_fma = true;

template <class T>
struct NeonRegister;
template <>
struct NeonRegister<double> {
  using type = float64x2_t;
};
template <>
struct NeonRegister<float> {
  using type = float32x4_t;
};
inline float64x2_t broadcast(double scalar) { return vdupq_n_f64(scalar); }
inline float32x4_t broadcast(float scalar) { return vdupq_n_f32(scalar); }

template <class T>
struct Pack {
  using Register = typename NeonRegister<T>::type;
  Register lanes;
  Pack() = default;
  Pack(T scalar) : lanes(broadcast(scalar)) {}
  Pack(Register lanes) : lanes(lanes) {}
  operator Register() const { return lanes; }
  friend Pack operator+(Pack a, Pack b) { return Register(a.lanes + b.lanes); }
  friend Pack operator-(Pack a, Pack b) { return Register(a.lanes - b.lanes); }
  friend Pack operator*(Pack a, Pack b) { return Register(a.lanes * b.lanes); }
  friend Pack operator/(Pack a, Pack b) { return Register(a.lanes / b.lanes); }
  friend Pack operator-(Pack a) { return Register(-a.lanes); }
};
using PackD = Pack<double>;
using PackF = Pack<float>;

inline PackD load(const double* p) { return vld1q_f64(p); }
inline PackF load(const float* p) { return vld1q_f32(p); }
inline void store(double* p, PackD a) { vst1q_f64(p, a); }
inline void store(float* p, PackF a) { vst1q_f32(p, a); }
inline PackD fma(PackD a, PackD b, PackD c) { return vfmaq_f64(c, a, b); }
inline PackF fma(PackF a, PackF b, PackF c) { return vfmaq_f32(c, a, b); }
inline PackD shift_up(PackD below, PackD a) { return vextq_f64(below, a, 1); }
inline PackF shift_up(PackF below, PackF a) { return vextq_f32(below, a, 3); }
inline PackD shift_down(PackD a, PackD above) { return vextq_f64(a, above, 1); }
inline PackF shift_down(PackF a, PackF above) { return vextq_f32(a, above, 1); }
template <class T>
struct LaneChoice {
  uint8x16_t bytes; ///< counted over both packs
};
template <class T>
inline LaneChoice<T> lane_choice(const std::uint8_t* lanes) {
  std::uint8_t bytes[16];
  for (unsigned n = 0; n < 16; ++n)
    bytes[n] = std::uint8_t(lanes[n / sizeof(T)] * sizeof(T) + n % sizeof(T));
  return {vld1q_u8(bytes)};
}
inline PackD pick(PackD a, PackD b, LaneChoice<double> choice) {
  const uint8x16x2_t both = {{vreinterpretq_u8_f64(a), vreinterpretq_u8_f64(b)}};
  return vreinterpretq_f64_u8(vqtbl2q_u8(both, choice.bytes));
}
inline PackF pick(PackF a, PackF b, LaneChoice<float> choice) {
  const uint8x16x2_t both = {{vreinterpretq_u8_f32(a), vreinterpretq_u8_f32(b)}};
  return vreinterpretq_f32_u8(vqtbl2q_u8(both, choice.bytes));
}
inline PackD keep(LaneMask mask, PackD a) {
  const uint64x2_t selected = vtstq_u64(vdupq_n_u64(mask), uint64x2_t{1, 2});
  return vreinterpretq_f64_u64(vandq_u64(vreinterpretq_u64_f64(a), selected));
}
inline PackF keep(LaneMask mask, PackF a) {
  const uint32x4_t selected = vtstq_u32(vdupq_n_u32(mask), uint32x4_t{1, 2, 4, 8});
  return vreinterpretq_f32_u32(vandq_u32(vreinterpretq_u32_f32(a), selected));
}
inline bool is_zero(PackD a) { return vminvq_u32(vreinterpretq_u32_u64(vceqzq_f64(a))) != 0; }
inline bool is_zero(PackF a) { return vminvq_u32(vceqzq_f32(a)) != 0; }

} // namespace dss::simd
DSS_INLINE_END
