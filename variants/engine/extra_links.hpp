#pragma once
/// Extra links, which are links outside the grid.
#include "variants/engine/body_group.hpp"
#include "variants/engine/packed_rows.hpp"

#include <array>
#include <map>
#include <memory>
#include <span>

namespace dss {

/// Extra links, computed one by one; of an ensemble the same link of all members at once. What a
/// row's links do to it is then added up in the order of the links' numbers, so the sum does not
/// depend on the order in which they are computed.
template <class T, int W = simd::lanes<T>>
class ExtraLinks {
public:
  /// None.
  ExtraLinks() = default;
  explicit ExtraLinks(PackedRows<T, W>& packed);
  bool empty() const { return links_.empty(); }
  std::span<const LinkedRows> rows() const { return rows_; }
  /// Computes a link and keeps its wrenches.
  /// @param row_i, row_j  rows of its two elements
  /// @param fields        numbers that a pack of a row holds for each element
  void compute(int link, const T* row_i, const T* row_j, int fields);
  /// The index of a row among those with extra links.
  int index_of(int row) const;
  /// Adds up the links of a row.
  /// @param index   from index_of
  /// @param wrench  layout.wrench components a pack; lanes without extra links are left alone
  void add_up(int index, T* wrench);
  /// Computes all links, and adds them up in the rows' wrenches (PackedRows::extra_wrench).
  /// @param row  function from a row's number to its address
  template <class RowAddress>
  void evaluate(RowAddress&& row, int fields) {
    for (int n = 0; n < int(links_.size()); ++n)
      compute(n, row(rows_[std::size_t(n)].i), row(rows_[std::size_t(n)].j), fields);
    for (int n = 0; n < int(of_row_.size()); ++n)
      add_up(n, packed_->extra_wrench(std::size_t(of_row_[std::size_t(n)].row)));
  }
  std::size_t bytes() const;

private:
  struct Link {
    ExtraLinkConstants<T> constants;
    std::array<Place, 2> places; ///< of an ensemble: of the first member
  };
  struct End {
    int link, end;
  };
  struct RowLinks {
    int row;
    std::vector<End> ends; ///< by link
  };
  int components() const { return int(packed_->layout.wrench.size()); }
  /// Links that are computed at once.
  std::size_t width() const { return packed_->members().size(); }
  /// The wrench of an end, in units of `unit`, which the sum applies. So each element's sum is
  /// rounded once a link, as on devices.
  T* wrench_of(const End& end) {
    return &wrenches_[(std::size_t(end.link) * 2 + std::size_t(end.end)) * wrench_size()];
  }
  std::size_t wrench_size() const { return std::size_t(components()) * width(); }
  PackedRows<T, W>* packed_ = nullptr;
  std::vector<Link> links_;
  std::vector<ExtraLinkConstants<LaneNumbers<T>>> member_links_; ///< of an ensemble
  std::vector<T> units_;                                         ///< of each link and member
  std::vector<T> wrenches_;      ///< of each link both ends; components, of each all members
  std::vector<LinkedRows> rows_; ///< of each link
  std::vector<RowLinks> of_row_; ///< by row
};

/// The wrenches of rows with extra links, apart from those of PackedRows: blocks may compute
/// different sweeps of a row, and the same link, at the same time.
template <class T>
class ExtraWrenches {
public:
  template <int W>
  ExtraWrenches(PackedRows<T, W>& packed, std::span<const LinkedRows> links);
  /// Where a row's extra links are added up.
  T* wrench(int row) { return rows_.at(row)->wrench.data(); }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& [row, linked] : rows_)
      sum += linked->wrench.bytes() + linked->patterns.size() * sizeof(linked->patterns[0]);
    return sum;
  }
  /// All that is applied to a row, with its extra links from here; null if it has none.
  const Applied<T>* applied(int row) const {
    const auto found = rows_.find(row);
    return found == rows_.end() ? nullptr : &found->second->applied;
  }

private:
  struct LinkedRow {
    Buffer<T> wrench;
    std::vector<typename Applied<T>::Pattern> patterns;
    Applied<T> applied;
  };
  std::map<int, std::unique_ptr<LinkedRow>> rows_;
};

} // namespace dss
