#pragma once
/// The pack of one lane, and what every header of packs (DSS_ISA_PACKS, simd.hpp) must declare
/// besides `has_fma`.
#include "kernels/simd/inline.hpp"
#include "kernels/simd/lane_mask.hpp"

DSS_INLINE_BEGIN
namespace dss::simd {

/// Numbers that are computed together: a number itself, or a class with the operators + - * /. A
/// class has an overload of fma(a, b, c) = a * b + c, rounded once.
template <class T>
using Pack = T;

/// @param p  aligned to the size of a pack
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
/// Which lanes pick() takes, counted over its two packs: of each lane of the result one.
template <class T>
struct LaneChoice {
  bool is_second;
};
template <class T>
inline LaneChoice<T> lane_choice(const std::uint8_t* lanes) {
  return {*lanes != 0};
}
/// [(a, b).choice_0, (a, b).choice_1, ...].
template <class T>
inline T pick(T a, T b, LaneChoice<T> choice) {
  return choice.is_second ? b : a;
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

} // namespace dss::simd
DSS_INLINE_END
