#include "variants/engine/extra_links.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>

namespace dss {
namespace {

template <class T>
T* lane(T* row, const Place& place, int components, int lanes) {
  return row + std::ptrdiff_t(place.pack) * components * lanes + place.lane;
}

} // namespace

template <class T, int W>
ExtraLinks<T, W>::ExtraLinks(PackedRows<T, W>& packed) : packed_(&packed) {
  std::map<int, std::vector<End>> of_row;
  const Problem& first = *packed.members().front();
  for (std::size_t n = 0; n < first.extra_links.size(); ++n) {
    const ExtraLink& link = first.extra_links[n];
    const auto place = [&](std::size_t element) {
      return place_of(packed, packed.element_of(0, element));
    };
    links_.push_back({extra_link_constants<T>(first, link), {place(link.i), place(link.j)}});
    rows_.push_back({int(links_.back().places[0].row), int(links_.back().places[1].row)});
    of_row[rows_.back().i].push_back({int(n), 0});
    of_row[rows_.back().j].push_back({int(n), 1});
    for (const Problem* member : packed.members())
      units_.push_back(extra_link_constants<T>(*member, member->extra_links[n]).unit);
    if (packed.is_ensemble()) member_links_.push_back(packed.member_link_constants(n));
  }
  wrenches_.resize(links_.size() * 2 * wrench_size());
  for (auto& [row, ends] : of_row) of_row_.push_back({row, std::move(ends)});
}

template <class T, int W>
void ExtraLinks<T, W>::compute(int n, const T* row_i, const T* row_j, int fields) {
  Link& link = links_[std::size_t(n)];
  const std::array rows{row_i, row_j};
  alignas(64) T state[2][field_count * W];
  for (std::size_t e = 0; e < 2; ++e) {
    const T* const from = lane(rows[e], link.places[e], fields, W);
    for (int f = 0; f < packed_->fields(); ++f)
      std::copy_n(from + f * W, width(), state[e] + std::size_t(f) * width());
  }
  const KernelSet<T>& kernels = *packed_->rows[link.places[0].row].kernels;
  alignas(64) T wrench[2][6 * W];
  // A model without the link's axis leaves them as they are.
  for (T* const end : wrench) std::fill_n(end, wrench_size(), T(0));
  if (packed_->is_ensemble())
    kernels.member_links(member_links_[std::size_t(n)], state[0], state[1], wrench[0], wrench[1]);
  else
    kernels.extra_link(link.constants, state[0], state[1], wrench[0], wrench[1]);
  for (int e = 0; e < 2; ++e) std::copy_n(wrench[e], wrench_size(), wrench_of({n, e}));
}

template <class T, int W>
void ExtraLinks<T, W>::add_up(int index, T* wrench) {
  const RowLinks& links = of_row_[std::size_t(index)];
  const auto target = [&](const End& end) {
    return lane(wrench, links_[std::size_t(end.link)].places[std::size_t(end.end)], components(),
                W);
  };
  const std::size_t members = width();
  for (const End& end : links.ends)
    for (int c = 0; c < components(); ++c) std::fill_n(target(end) + c * W, members, T(0));
  for (const End& end : links.ends) {
    const T* const own = wrench_of(end);
    const T* const unit = &units_[std::size_t(end.link) * members];
    T* const sum = target(end);
    for (int c = 0; c < components(); ++c)
      for (std::size_t m = 0; m < members; ++m)
        sum[std::size_t(c * W) + m] =
            simd::fma(unit[m], own[std::size_t(c) * members + m], sum[std::size_t(c * W) + m]);
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
  return links_.size() * (sizeof(Link) + sizeof(LinkedRows) + 2 * sizeof(End)) +
         member_links_.size() * sizeof(member_links_[0]) +
         (units_.size() + wrenches_.size()) * sizeof(T);
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
