#pragma once
/// Numbers of a pack in memory and in the lanes beside them. None of this depends on the terms or
/// the action of a row, so it is compiled once for all of them.
///
/// A Tuple is a model's element, vec, spin or rotor over packs of T.
#include "kernels/physics.hpp"
#include "kernels/stage_row/row.hpp"

#include <cstddef>

DSS_INLINE_BEGIN
namespace dss {

/// Loads numbers that follow one another, and moves p behind them.
template <class Tuple, class T>
Tuple load_next(const T*& p) {
  Tuple t{};
  each_component(t, [&](auto& c) { c = simd::load(p), p += simd::lanes<T>; });
  return t;
}
template <class Tuple, class T>
Tuple load_at(const T* p) {
  return load_next<Tuple>(p);
}
/// Stores numbers one after another, and moves p behind them.
template <class Tuple, class T>
void store_next(T*& p, Tuple t) {
  each_component(t, [&](auto& c) { simd::store(p, c), p += simd::lanes<T>; });
}
template <class Tuple>
Tuple zero() {
  Tuple t{};
  each_component(t, []<class R>(R& c) { c = R(0); });
  return t;
}
/// `value(n)` gives x, y, z; a model takes the components that it has.
template <class Tuple, class Value>
Tuple components(Value&& value) {
  Tuple t{};
  if constexpr (requires { t.x; }) t.x = value(0);
  if constexpr (requires { t.y; }) t.y = value(1);
  if constexpr (requires { t.z; }) t.z = value(2);
  return t;
}
/// Clears the lanes that are not in a mask.
template <class Tuple>
void keep_lanes(simd::LaneMask mask, Tuple& t) {
  each_component(t, [&](auto& c) { c = simd::keep(mask, c); });
}

/// Of each lane, the number of its upper neighbour along x.
/// @param next  the next pack of the row
template <LaneKind kind, class Tuple>
Tuple from_above(const Tuple& a, const Tuple& next) {
  if constexpr (kind == LaneKind::members)
    return next;
  else
    return each_pair(a, next, [](const auto& x, const auto& y) { return simd::shift_down(x, y); });
}
/// Of each lane, the number of its lower neighbour along x.
template <LaneKind kind, class Tuple>
Tuple from_below(const Tuple& previous, const Tuple& a) {
  if constexpr (kind == LaneKind::members)
    return previous;
  else
    return each_pair(previous, a,
                     [](const auto& x, const auto& y) { return simd::shift_up(x, y); });
}

/// Copies numbers of a pack from any lanes of a row.
/// @param size    numbers from pack to pack of `from`
/// @param places  of each lane, as RowTask::places
template <class T>
[[gnu::noinline]] void collect_lanes(const T* from, std::ptrdiff_t size, int numbers,
                                     const int* places, T* to) {
  constexpr int W = simd::lanes<T>;
  for (int l = 0; l < W; ++l) {
    const T* const lane = from + places[l] / W * size + places[l] % W;
    for (int n = 0; n < numbers; ++n) to[n * W + l] = lane[n * W];
  }
}
/// Loads a pack's neighbours from another row.
/// @tparam numbers  of the Tuple
/// @param size    numbers from pack to pack of `from`
/// @param places  RowTask::places
template <class Tuple, int numbers, class T>
Tuple load_mapped(const T* from, std::ptrdiff_t size, const LaneMap<T>& map, const int* places) {
  if (map.is_scattered()) [[unlikely]] {
    alignas(64) T lanes[numbers > 0 ? numbers * simd::lanes<T> : 1];
    collect_lanes(from, size, numbers, places + map.first, lanes);
    return load_at<Tuple>(lanes);
  }
  Tuple t{};
  const T *first = from + map.first * size, *second = from + map.second * size;
  const auto choice = simd::lane_choice<T>(map.lanes);
  each_component(t, [&](auto& c) {
    c = simd::pick(simd::load(first), simd::load(second), choice);
    first += simd::lanes<T>, second += simd::lanes<T>;
  });
  return t;
}

} // namespace dss
DSS_INLINE_END
