#pragma once
/// Packs of lanes for the instruction set that the including module is compiled for; the only file
/// that includes xsimd. DSS_VECTOR_BITS: 0 (a pack is a scalar), 256 (AVX2 and FMA) or 512 (AVX-512
/// F, DQ, VL). xsimd 8.1 (Debian 12) has no AVX-512 FMA and no two-source lane shifts: those few
/// operations are intrinsics here.
#include <cmath>
#include <cstdint>
#include <cstring>

#ifndef DSS_VECTOR_BITS
#define DSS_VECTOR_BITS 0
#endif

#if DSS_VECTOR_BITS > 0
#include <immintrin.h>
#include <xsimd/xsimd.hpp>
#endif

// Every call in the hot loop must be inlined: GCC does so for a flattened row kernel (DSS_FLATTEN),
// Clang wants it said at each function. Not under sanitizers, where one flattened kernel would
// compile for minutes.
#ifdef DSS_SANITIZED
#define DSS_FLATTEN
#define DSS_INLINE_BEGIN
#define DSS_INLINE_END
#else
#define DSS_FLATTEN [[gnu::flatten]]
#ifdef __clang__
#define DSS_INLINE_BEGIN                                                                           \
  _Pragma("clang attribute push(__attribute__((always_inline)), apply_to = function)")
#define DSS_INLINE_END _Pragma("clang attribute pop")
#else
#define DSS_INLINE_BEGIN
#define DSS_INLINE_END
#endif
#endif

DSS_INLINE_BEGIN
namespace dss::simd {

/// One bit a lane, lane 0 lowest.
using LaneMask = std::uint16_t;

#if DSS_VECTOR_BITS > 0
#if DSS_VECTOR_BITS == 512
template <class T>
using Batch = xsimd::batch<T, xsimd::avx512dq>;
#else
template <class T>
using Batch = xsimd::batch<T, xsimd::avx2>;
#endif
/// xsimd's batch with a unary minus that the compiler can fold into a fused multiply-add (xsimd's
/// is 0 - a, an instruction of its own).
template <class T>
struct Pack {
  using Register = typename Batch<T>::register_type;
  Batch<T> batch;
  Pack() = default;
  Pack(T scalar) : batch(scalar) {}
  Pack(Register lanes) : batch(lanes) {}
  Pack(Batch<T> lanes) : batch(lanes) {}
  operator Register() const { return batch; }
  friend Pack operator+(Pack a, Pack b) { return a.batch + b.batch; }
  friend Pack operator-(Pack a, Pack b) { return a.batch - b.batch; }
  friend Pack operator*(Pack a, Pack b) { return a.batch * b.batch; }
  friend Pack operator/(Pack a, Pack b) { return a.batch / b.batch; }
  friend Pack operator-(Pack a) { return Register(-Register(a.batch)); }
};
#else
template <class T>
using Pack = T;
#endif

template <class T>
constexpr int lanes = DSS_VECTOR_BITS > 0 ? DSS_VECTOR_BITS / 8 / int(sizeof(T)) : 1;
template <class T>
constexpr LaneMask all_lanes = LaneMask((1u << lanes<T>)-1);

/// Scalar a * b + c: fused exactly where the module's instruction set has FMA (never a call of the
/// C library's software fma).
template <class T>
inline T scalar_fma(T a, T b, T c) {
#ifdef __FMA__
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}
inline double fma(double a, double b, double c) { return scalar_fma(a, b, c); }
inline float fma(float a, float b, float c) { return scalar_fma(a, b, c); }

#if DSS_VECTOR_BITS == 0
template <class T>
inline T load(const T* p) {
  return *p;
}
template <class T>
inline void store(T* p, T a) {
  *p = a;
}
/// Lanes moved up by one, the lowest from the top of `below`: [below.last, a.0, a.1, ...].
template <class T>
inline T shift_up(T below, T) {
  return below;
}
/// Lanes moved down by one, the topmost from the bottom of `above`: [a.1, a.2, ..., above.0].
template <class T>
inline T shift_down(T, T above) {
  return above;
}
/// a where the mask has its bit, 0 elsewhere.
template <class T>
inline T keep(LaneMask mask, T a) {
  return (mask & 1) != 0 ? a : T(0);
}
/// True if every lane equals zero; false for NaN.
template <class T>
inline bool is_zero(T a) {
  return a == T(0);
}
#else
template <class T>
inline Pack<T> load(const T* p) {
  return Batch<T>::load_aligned(p);
}
template <class T>
inline void store(T* p, Pack<T> a) {
  a.batch.store_aligned(p);
}
#endif

#if DSS_VECTOR_BITS == 512
using PackD = Pack<double>;
using PackF = Pack<float>;
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
inline PackD keep(LaneMask mask, PackD a) { return _mm512_maskz_mov_pd(__mmask8(mask), a); }
inline PackF keep(LaneMask mask, PackF a) { return _mm512_maskz_mov_ps(mask, a); }
inline bool is_zero(PackD a) {
  return _mm512_cmp_pd_mask(a, _mm512_setzero_pd(), _CMP_EQ_OQ) == 0xff;
}
inline bool is_zero(PackF a) {
  return _mm512_cmp_ps_mask(a, _mm512_setzero_ps(), _CMP_EQ_OQ) == 0xffff;
}
#elif DSS_VECTOR_BITS == 256
using PackD = Pack<double>;
using PackF = Pack<float>;
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
#endif

} // namespace dss::simd
DSS_INLINE_END
