#include "variants/engine/extra_links.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>
#include <utility>

namespace dss {
namespace {

template <class T>
T* lane(T* row, const Place& place, int components, int lanes) {
  return row + std::ptrdiff_t(place.pack) * components * lanes + place.lane;
}

} // namespace

template <class T, int W>
ExtraLinks<T, W>::ExtraLinks(const Problem& problem, PackedRows<T, W>& packed) : packed_(&packed) {
  std::map<int, std::vector<End>> of_row;
  for (const ExtraLink& link : problem.extra_links) {
    const int n = int(links_.size());
    Link kept{extra_link_constants<T>(problem, link),
              {place_of(packed, link.i), place_of(packed, link.j)},
              {},
              1};
    kept.unit = std::exchange(kept.constants.unit, T(1));
    rows_.push_back({int(kept.places[0].row), int(kept.places[1].row)});
    of_row[rows_.back().i].push_back({n, 0});
    of_row[rows_.back().j].push_back({n, 1});
    links_.push_back(kept);
  }
  for (auto& [row, ends] : of_row) of_row_.push_back({row, std::move(ends)});
}

template <class T, int W>
void ExtraLinks<T, W>::compute(int n, const T* row_i, const T* row_j, int fields) {
  Link& link = links_[std::size_t(n)];
  const std::array rows{row_i, row_j};
  T state[2][field_count];
  for (std::size_t e = 0; e < 2; ++e) {
    const T* const from = lane(rows[e], link.places[e], fields, W);
    for (int f = 0; f < packed_->fields(); ++f) state[e][f] = from[f * W];
  }
  link.wrenches = {};
  packed_->rows[link.places[0].row].kernels->extra_link(
      link.constants, state[0], state[1], link.wrenches[0].data(), link.wrenches[1].data());
}

template <class T, int W>
void ExtraLinks<T, W>::add_up(int index, T* wrench) const {
  const RowLinks& links = of_row_[std::size_t(index)];
  const auto target = [&](const End& end) {
    return lane(wrench, links_[std::size_t(end.link)].places[std::size_t(end.end)], components(),
                W);
  };
  for (const End& end : links.ends)
    for (int c = 0; c < components(); ++c) target(end)[c * W] = 0;
  for (const End& end : links.ends) {
    const Link& link = links_[std::size_t(end.link)];
    T* const sum = target(end);
    for (int c = 0; c < components(); ++c)
      sum[c * W] =
          simd::fma(link.unit, link.wrenches[std::size_t(end.end)][std::size_t(c)], sum[c * W]);
  }
}

template <class T, int W>
int ExtraLinks<T, W>::index_of(int row) const {
  const auto links = std::lower_bound(of_row_.begin(), of_row_.end(), row,
                                      [](const RowLinks& l, int r) { return l.row < r; });
  return int(links - of_row_.begin());
}

template <class T, int W>
std::size_t ExtraLinks<T, W>::bytes() const {
  return links_.size() * (sizeof(Link) + sizeof(LinkedRows) + 2 * sizeof(End));
}

template <class T>
template <int W>
ExtraWrenches<T>::ExtraWrenches(PackedRows<T, W>& packed, std::span<const LinkedRows> links) {
  for (const auto& [i, j] : links)
    for (const int r : {i, j}) {
      std::unique_ptr<LinkedRow>& row = rows_[r];
      if (row != nullptr) continue;
      const Applied<T>& all = *packed.rows[std::size_t(r)].applied;
      const T* const shared = packed.extra_wrench(std::size_t(r));
      const std::size_t size =
          std::size_t(packed.rows[std::size_t(r)].packs) * packed.layout.wrench.size() * W;
      row = std::make_unique<LinkedRow>(LinkedRow{
          Buffer<T>(size, packed.memory), {all.patterns, all.patterns + all.pattern_count}, all});
      for (auto& pattern : row->patterns)
        if (pattern.values == shared) pattern.values = row->wrench.data();
      row->applied.patterns = row->patterns.data();
    }
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template class ExtraLinks<T, W>;                                                                 \
  template ExtraWrenches<T>::ExtraWrenches(PackedRows<T, W>&, std::span<const LinkedRows>);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
