#pragma once
/// Packs of AVX2 and FMA: 4 doubles or 8 floats.
#include "variants/isa/xsimd_pack.hpp"
#include <immintrin.h>

DSS_INLINE_BEGIN
namespace dss::simd {

inline constexpr bool has_fma = true;

template <class T>
using Pack = XsimdPack<T, xsimd::avx2>;
using PackD = Pack<double>;
using PackF = Pack<float>;

template <class T>
inline Pack<T> load(const T* p) {
  return Pack<T>::Batch::load_aligned(p);
}
inline PackD fma(PackD a, PackD b, PackD c) { return _mm256_fmadd_pd(a, b, c); }
inline PackF fma(PackF a, PackF b, PackF c) { return _mm256_fmadd_ps(a, b, c); }
inline PackD shift_up(PackD below, PackD a) {
  const __m256d middle = _mm256_permute2f128_pd(below, a, 0x21); // [below.2, below.3, a.0, a.1]
  return _mm256_shuffle_pd(middle, a, 0b0101);
}
inline PackF shift_up(PackF below, PackF a) {
  const __m256i high = _mm256_castps_si256(a);
  const __m256i middle = _mm256_permute2x128_si256(_mm256_castps_si256(below), high, 0x21);
  return _mm256_castsi256_ps(_mm256_alignr_epi8(high, middle, 12));
}
inline PackD shift_down(PackD a, PackD above) {
  const __m256d middle = _mm256_permute2f128_pd(a, above, 0x21); // [a.2, a.3, above.0, above.1]
  return _mm256_shuffle_pd(a, middle, 0b0101);
}
inline PackF shift_down(PackF a, PackF above) {
  const __m256i low = _mm256_castps_si256(a);
  const __m256i middle = _mm256_permute2x128_si256(low, _mm256_castps_si256(above), 0x21);
  return _mm256_castsi256_ps(_mm256_alignr_epi8(middle, low, 4));
}
template <class T>
struct LaneChoice {
  __m256i lanes;     ///< of 32 bits; the permutation counts them modulo 8
  __m256i is_second; ///< all bits of a lane of T
};
template <class T>
inline LaneChoice<T> lane_choice(const std::uint8_t* lanes) {
  if constexpr (sizeof(T) == sizeof(float)) {
    const auto* const from = reinterpret_cast<const __m128i*>(lanes);
    const __m256i lane = _mm256_cvtepu8_epi32(_mm_loadl_epi64(from));
    return {lane, _mm256_cmpgt_epi32(lane, _mm256_set1_epi32(7))};
  } else {
    const __m256i lane = _mm256_cvtepu8_epi64(_mm_loadu_si32(lanes));
    const __m256i low = _mm256_add_epi64(lane, lane), one = _mm256_set1_epi64x(1);
    return {_mm256_or_si256(low, _mm256_slli_epi64(_mm256_add_epi64(low, one), 32)),
            _mm256_cmpgt_epi64(lane, _mm256_set1_epi64x(3))};
  }
}
inline PackF pick(PackF a, PackF b, LaneChoice<float> choice) {
  return _mm256_blendv_ps(_mm256_permutevar8x32_ps(a, choice.lanes),
                          _mm256_permutevar8x32_ps(b, choice.lanes),
                          _mm256_castsi256_ps(choice.is_second));
}
inline PackD pick(PackD a, PackD b, LaneChoice<double> choice) {
  const __m256 low = _mm256_permutevar8x32_ps(_mm256_castpd_ps(a), choice.lanes),
               high = _mm256_permutevar8x32_ps(_mm256_castpd_ps(b), choice.lanes);
  return _mm256_castps_pd(_mm256_blendv_ps(low, high, _mm256_castsi256_ps(choice.is_second)));
}
inline __m256i lane_select_64(LaneMask mask) {
  const __m256i bit = _mm256_setr_epi64x(1, 2, 4, 8);
  return _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(mask), bit), bit);
}
inline __m256i lane_select_32(LaneMask mask) {
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask), bit), bit);
}
inline PackD keep(LaneMask mask, PackD a) {
  return _mm256_and_pd(a, _mm256_castsi256_pd(lane_select_64(mask)));
}
inline PackF keep(LaneMask mask, PackF a) {
  return _mm256_and_ps(a, _mm256_castsi256_ps(lane_select_32(mask)));
}
inline bool is_zero(PackD a) {
  return _mm256_movemask_pd(_mm256_cmp_pd(a, _mm256_setzero_pd(), _CMP_EQ_OQ)) == 0xf;
}
inline bool is_zero(PackF a) {
  return _mm256_movemask_ps(_mm256_cmp_ps(a, _mm256_setzero_ps(), _CMP_EQ_OQ)) == 0xff;
}

} // namespace dss::simd
DSS_INLINE_END
