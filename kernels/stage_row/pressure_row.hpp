#pragma once
/// The sweep before a stage, if elements have a pressure: P and Q of a row's elements at the input
/// of the stage (kernels/link_force/link_force.h). It writes them behind the fields of the input,
/// where the stage reads them. A link's strain is computed once: the upper element finds it in the
/// next lane or in a carry buffer. The order of summation is that of the stage: x, y, z; the upper
/// link before the lower; then loads.
#include "kernels/stage_row/stage_row.hpp"

#include <array>

DSS_INLINE_BEGIN
namespace dss {

/// Parameters as StageRow.
template <class P, class T, Terms terms, LaneKind kind>
struct PressureRow : StageRow<P, T, terms, kind> {
  using Stage = StageRow<P, T, terms, kind>;
  using R = typename Stage::R;
  using element = typename Stage::element;
  using Stored = typename Stage::Stored;
  using Stage::body, Stage::task, Stage::W, Stage::parts;

  explicit PressureRow(const RowTask<T>& of_row) : Stage{of_row} {}

  /// The parts that a row stores.
  static Stored narrowed(const typename Stage::pressure& p) {
    Stored stored{};
    if constexpr (parts.has_volume) stored.s = p.s;
    if constexpr (parts.has_bending_x) stored.x = p.x;
    if constexpr (parts.has_bending_y) stored.y = p.y;
    if constexpr (parts.has_bending_z) stored.z = p.z;
    return stored;
  }
  static void add(Stored& sum, const Stored& more) {
    sum = each_pair(sum, more, [](const R& a, const R& b) { return a + b; });
  }
  Stored strain(const element& i, const element& j, const int axis, simd::LaneMask mask) const {
    Stored of_link = narrowed(P::link_strain(i, j, axis, R(body.edge[axis]),
                                             R(body.inverse_edge[axis]), parts.has_bending()));
    if (mask != simd::all_lanes<T>) keep_lanes(mask, of_link);
    return of_link;
  }
  T* carried(T* carry, int pack) const { return carry + std::ptrdiff_t(pack) * Stage::carry_size; }
  void store_parts(T* to, const Stored& of_link) const { store_next(to, of_link); }
  Stored load_lower(const T* from, int pack, int axis, simd::LaneMask below) const {
    if constexpr (Stage::is_filled) {
      Stored of_link = load_mapped<Stored, parts.count()>(from, Stage::carry_size,
                                                          task.maps[pack].lower(axis), task.places);
      keep_lanes(below, of_link); // as in StageRow::load_lower
      return of_link;
    } else {
      return load_at<Stored>(from + std::ptrdiff_t(pack) * Stage::carry_size);
    }
  }

  void add_across(const element& i, const int axis, int pack, simd::LaneMask above,
                  simd::LaneMask below, Stored& sum) const {
    const T* const upper = axis == 1 ? task.upper_y : task.upper_z;
    Stored up{};
    if (above != 0) {
      up = strain(i, this->load_upper(upper, pack, task.stride, axis), axis, above);
      add(sum, up);
    }
    if (below != 0) add(sum, load_lower(axis == 1 ? task.from_y : task.from_z, pack, axis, below));
    // The carry buffer may be the same as `from`, which has been read.
    if (above != 0) store_parts(carried(axis == 1 ? task.carry_y : task.carry_z, pack), up);
  }
  void add_loads(int pack, Stored& sum) const {
    const Applied<T>* const loads = task.pressure->loads;
    if constexpr (parts.has_volume)
      for (int n = 0; loads != nullptr && n < loads->pattern_count; ++n) {
        const auto& pattern = loads->patterns[n];
        if (unsigned(pack - pattern.first) >= unsigned(pattern.packs)) continue;
        const T* const share = pattern.values + std::ptrdiff_t(pack - pattern.first) * W;
        sum.s = simd::fma(this->signal(pattern.signal), simd::load(share), sum.s);
      }
  }
  Stored of_strain(int pack, const Stored& sum) const {
    const PressureLanes<T>& c = task.pressure->constants[task.pressure->index[pack]];
    Stored result{};
    if constexpr (parts.has_volume) result.s = R(c.s) * sum.s;
    if constexpr (parts.has_bending_x) result.x = R(c.x) * sum.x;
    if constexpr (parts.has_bending_y) result.y = R(c.y) * sum.y;
    if constexpr (parts.has_bending_z) result.z = R(c.z) * sum.z;
    return result;
  }

  /// Writes the pressures of the row's elements.
  void run() const {
    element next = load_at<element>(task.in);
    Stored previous{};
    if (kind == LaneKind::neighbours && task.from_x != nullptr)
      previous = load_at<Stored>(task.from_x);
    for (int pack = 0; pack < task.packs; ++pack) {
      const PackMasks& masks = task.masks[pack];
      const std::ptrdiff_t place = std::ptrdiff_t(pack) * task.stride;
      const element i = next;
      next = load_at<element>(pack + 1 < task.packs ? task.in + place + task.stride : task.ahead);
      const Stored up = strain(i, from_above<kind>(i, next), 0, masks.link_x);
      Stored sum = up;
      add(sum, from_below<kind>(previous, up));
      previous = up;
      if constexpr (P::axes > 1) add_across(i, 1, pack, masks.link_y, masks.below_y, sum);
      if constexpr (P::axes > 2) add_across(i, 2, pack, masks.link_z, masks.below_z, sum);
      add_loads(pack, sum);
      store_parts(task.out + place + this->pressure_at(), of_strain(pack, sum));
    }
    if (kind == LaneKind::neighbours && task.carry_x != nullptr)
      store_parts(task.carry_x, previous);
  }
  /// Computes only the strain of the link from a piece of a cut row to the next one.
  void prime_x() const {
    const int last = task.packs - 1;
    const element i = load_at<element>(task.in + std::ptrdiff_t(last) * task.stride),
                  next = load_at<element>(task.ahead);
    store_parts(task.carry_x, strain(i, from_above<kind>(i, next), 0, task.masks[last].link_x));
  }
  /// Computes only the strains of the links across `axis` from this row to the upper one.
  void prime(const int axis) const {
    for (int pack = 0; pack < task.packs; ++pack) {
      const simd::LaneMask above = axis == 1 ? task.masks[pack].link_y : task.masks[pack].link_z;
      if (above == 0) continue;
      const T* const upper = axis == 1 ? task.upper_y : task.upper_z;
      const element i = load_at<element>(task.in + std::ptrdiff_t(pack) * task.stride);
      store_parts(carried(axis == 1 ? task.carry_y : task.carry_z, pack),
                  strain(i, this->load_upper(upper, pack, task.stride, axis), axis, above));
    }
  }
};

} // namespace dss
DSS_INLINE_END
