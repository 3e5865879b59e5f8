/// What acts on rows from outside: loads, clamps, and where extra links add their wrenches.
#include "solver/numerics/signal_rows.hpp"
#include "variants/engine/packed_rows.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace dss {

template <class T, int W>
typename PackedRows<T, W>::AppliedRow& PackedRows<T, W>::applied_row(std::size_t row) {
  if (applied_index_[row] < 0) {
    applied_index_[row] = int(applied_.size());
    applied_.push_back(std::make_unique<AppliedRow>());
  }
  return *applied_[std::size_t(applied_index_[row])];
}

template <class T, int W>
void PackedRows<T, W>::apply_loads() {
  for (std::size_t n = 0; n < members_.front()->loads.size(); ++n) apply_load(n);
}

template <class T, int W>
template <class RowAt, class Value>
void PackedRows<T, W>::add_patterns(std::size_t n, std::size_t components, RowAt&& row_at,
                                    Value&& value) {
  struct Loaded {
    Place place;
    const Load* load;
  };
  std::vector<Loaded> all;
  for (std::size_t m = 0; m < members_.size(); ++m)
    for (const std::size_t element : members_[m]->loads[n].elements)
      all.push_back({place_of(*this, element_of(m, element)), &members_[m]->loads[n]});
  std::ranges::stable_sort(
      all, {}, [](const Loaded& one) { return std::pair(one.place.row, one.place.pack); });
  for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
    const std::size_t r = all[from].place.row;
    while (to < all.size() && all[to].place.row == r) ++to;
    const int first = all[from].place.pack, packs = all[to - 1].place.pack - first + 1;
    AppliedRow& row = row_at(r);
    Buffer<T> values(std::size_t(packs) * components * W, memory);
    for (const auto& [place, load] : std::span(all).subspan(from, to - from))
      for (std::size_t c = 0; c < components; ++c)
        values.data()[(std::size_t(place.pack - first) * components + c) * W +
                      std::size_t(place.lane)] = T(value(*load, c));
    row.patterns.push_back({values.data(), int(3 + n), first, packs});
    row.values.push_back(std::move(values));
  }
}

template <class T, int W>
void PackedRows<T, W>::apply_load(std::size_t n) {
  add_patterns(
      n, layout.wrench.size(), [&](std::size_t r) -> AppliedRow& { return applied_row(r); },
      [&](const Load& load, std::size_t c) {
        const std::size_t w = std::size_t(layout.wrench[c]);
        return w < 3 ? load.force[w] : load.torque[w - 3];
      });
}

template <class T, int W>
void PackedRows<T, W>::apply_face_strains() {
  if (row_pressures_.empty()) return;
  face_strains_.resize(rows.size());
  const auto row_at = [&](std::size_t r) -> AppliedRow& {
    if (face_strains_[r] == nullptr) face_strains_[r] = std::make_unique<AppliedRow>();
    return *face_strains_[r];
  };
  for (std::size_t n = 0; n < members_.front()->loads.size(); ++n)
    if (std::ranges::any_of(
            members_, [&](const Problem* member) { return member->loads[n].face_strain != 0; }))
      add_patterns(n, 1, row_at,
                   [](const Load& load, std::size_t) { return 2 * load.face_strain; });
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (face_strains_[r] == nullptr) continue;
    face_strains_[r]->cover_patterns();
    row_pressures_[r].loads = &face_strains_[r]->applied;
  }
}

template <class T, int W>
void PackedRows<T, W>::place_at_rest() {
  if (!members_.front()->has_rotating_frame()) return;
  for (PackedRow<T>& row : rows) {
    rest_.emplace_back(std::size_t(row.packs) * 3 * W, memory);
    row.rest = rest_.back().data();
  }
  for (std::size_t m = 0; m < members_.size(); ++m)
    members_[m]->lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
      const Place place = place_of(*this, element_of(m, e));
      const Vec3 rest = rest_position(*members_[m], row, x);
      for (std::size_t c = 0; c < 3; ++c)
        rest_[place.row].data()[(std::size_t(place.pack) * 3 + c) * W + std::size_t(place.lane)] =
            T(rest[c]);
    });
}

template <class T, int W>
void PackedRows<T, W>::set_mass_ratios() {
  if (!members_.front()->has_mass_ratios()) return;
  for (PackedRow<T>& row : rows) {
    inverse_ratios_.emplace_back(std::size_t(row.packs) * W, memory);
    row.inverse_ratios = inverse_ratios_.back().data();
  }
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const Problem& member = *members_[m];
    member.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
      const Place place = place_of(*this, element_of(m, e));
      inverse_ratios_[place.row].data()[std::size_t(place.pack) * W + std::size_t(place.lane)] =
          T(1 / member.mass_ratio(e, member.bodies[std::size_t(row.body)]));
    });
  }
}

template <class T, int W>
void PackedRows<T, W>::AppliedRow::cover_patterns() {
  applied.patterns = patterns.data();
  applied.pattern_count = int(patterns.size());
  applied.first = patterns.front().first;
  int end = 0;
  for (const auto& p : patterns) {
    applied.first = std::min(applied.first, p.first);
    end = std::max(end, p.first + p.packs);
  }
  applied.packs = end - applied.first;
}

template <class T, int W>
void PackedRows<T, W>::apply_extra_links(const Problem& problem) {
  stage_halo = reach;
  if (problem.extra_links.empty()) return;
  extra_.resize(rows.size());
  const int constant_one = int(signal_count(problem));
  for (const ExtraLink& link : problem.extra_links) {
    const std::size_t linked[] = {place_of(*this, element_of(0, link.i)).row,
                                  place_of(*this, element_of(0, link.j)).row};
    stage_halo = std::max(stage_halo, std::abs(int(linked[0]) - int(linked[1])));
    for (const std::size_t r : linked) {
      if (!extra_[r].empty()) continue;
      extra_[r] = Buffer<T>(std::size_t(rows[r].packs) * layout.wrench.size() * W, memory);
      applied_row(r).patterns.push_back({extra_[r].data(), constant_one, 0, rows[r].packs});
    }
  }
}

template <class T, int W>
void PackedRows<T, W>::apply_clamps() {
  const std::size_t components = layout.wrench.size();
  for (std::size_t m = 0; m < members_.size(); ++m)
    for (const Clamp& clamp : members_[m]->clamps) {
      const Place place = place_of(*this, element_of(m, clamp.element));
      AppliedRow& row = applied_row(place.row);
      if (row.free_lanes.empty())
        row.free_lanes.assign(std::size_t(rows[place.row].packs) * components, all_lanes);
      for (std::size_t c = 0; c < components; ++c)
        if ((clamp.dofs >> layout.wrench[c] & 1) != 0)
          row.free_lanes[std::size_t(place.pack) * components + c] &=
              simd::LaneMask(~(1u << place.lane));
    }
}

template <class T, int W>
void PackedRows<T, W>::hand_out_applied() {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (applied_index_[r] < 0) continue;
    AppliedRow& row = *applied_[std::size_t(applied_index_[r])];
    if (!row.patterns.empty()) row.cover_patterns();
    if (!row.free_lanes.empty()) { // clamps: all packs
      row.applied.first = 0;
      row.applied.packs = rows[r].packs;
    }
    row.applied.free_lanes = row.free_lanes.empty() ? nullptr : row.free_lanes.data();
    rows[r].applied = &row.applied;
  }
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template void PackedRows<T, W>::apply_loads();                                                   \
  template void PackedRows<T, W>::apply_face_strains();                                            \
  template void PackedRows<T, W>::place_at_rest();                                                 \
  template void PackedRows<T, W>::set_mass_ratios();                                               \
  template void PackedRows<T, W>::apply_extra_links(const Problem&);                               \
  template void PackedRows<T, W>::apply_clamps();                                                  \
  template void PackedRows<T, W>::hand_out_applied();
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
