#pragma once
/// Packs of AVX-512 (F, DQ, VL): 8 doubles or 16 floats.
#include "variants/isa/xsimd_pack.hpp"
#include <immintrin.h>

DSS_INLINE_BEGIN
namespace dss::simd {

inline constexpr bool has_fma = true;

template <class T>
using Pack = XsimdPack<T, xsimd::avx512dq>;
using PackD = Pack<double>;
using PackF = Pack<float>;

template <class T>
inline Pack<T> load(const T* p) {
  return Pack<T>::Batch::load_aligned(p);
}
inline PackD fma(PackD a, PackD b, PackD c) { return _mm512_fmadd_pd(a, b, c); }
inline PackF fma(PackF a, PackF b, PackF c) { return _mm512_fmadd_ps(a, b, c); }
inline PackD shift_up(PackD below, PackD a) {
  return _mm512_castsi512_pd(
      _mm512_maskz_alignr_epi64(0xff, _mm512_castpd_si512(a), _mm512_castpd_si512(below), 7));
}
inline PackF shift_up(PackF below, PackF a) {
  return _mm512_castsi512_ps(
      _mm512_maskz_alignr_epi32(0xffff, _mm512_castps_si512(a), _mm512_castps_si512(below), 15));
}
inline PackD shift_down(PackD a, PackD above) {
  return _mm512_castsi512_pd(
      _mm512_maskz_alignr_epi64(0xff, _mm512_castpd_si512(above), _mm512_castpd_si512(a), 1));
}
inline PackF shift_down(PackF a, PackF above) {
  return _mm512_castsi512_ps(
      _mm512_maskz_alignr_epi32(0xffff, _mm512_castps_si512(above), _mm512_castps_si512(a), 1));
}
template <class T>
struct LaneChoice {
  __m512i lanes;
};
template <class T>
inline LaneChoice<T> lane_choice(const std::uint8_t* lanes) {
  const auto* const from = reinterpret_cast<const __m128i*>(lanes);
  if constexpr (sizeof(T) == sizeof(double))
    return {_mm512_maskz_cvtepu8_epi64(0xff, _mm_loadl_epi64(from))};
  else
    return {_mm512_maskz_cvtepu8_epi32(0xffff, _mm_loadu_si128(from))};
}
inline PackD pick(PackD a, PackD b, LaneChoice<double> choice) {
  return _mm512_permutex2var_pd(a, choice.lanes, b);
}
inline PackF pick(PackF a, PackF b, LaneChoice<float> choice) {
  return _mm512_permutex2var_ps(a, choice.lanes, b);
}
inline PackD keep(LaneMask mask, PackD a) { return _mm512_maskz_mov_pd(__mmask8(mask), a); }
inline PackF keep(LaneMask mask, PackF a) { return _mm512_maskz_mov_ps(mask, a); }
inline bool is_zero(PackD a) {
  return _mm512_cmp_pd_mask(a, _mm512_setzero_pd(), _CMP_EQ_OQ) == 0xff;
}
inline bool is_zero(PackF a) {
  return _mm512_cmp_ps_mask(a, _mm512_setzero_ps(), _CMP_EQ_OQ) == 0xffff;
}

} // namespace dss::simd
DSS_INLINE_END
