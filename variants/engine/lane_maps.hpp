#pragma once
/// Where the neighbours of a filled row's elements lie in the packs of the rows beside it.
#include "kernels/stage_row/row.hpp"
#include "variants/engine/filled_rows.hpp"

namespace dss {

/// The maps of all filled rows whose neighbours lie in other lanes.
template <class T>
class LaneMaps {
public:
  /// None.
  LaneMaps() = default;
  /// @param cells  of which the rows were made
  LaneMaps(const FilledRows& filled, const Lattice& cells);
  /// Null if the neighbours lie in the same lanes.
  const PackMaps<T>* of_row(std::size_t row) const {
    return begin_.empty() || begin_[row] < 0 ? nullptr : &maps_[std::size_t(begin_[row])];
  }
  /// RowTask::places.
  const int* places() const { return places_.data(); }
  std::size_t bytes() const {
    return begin_.size() * sizeof(begin_[0]) + maps_.size() * sizeof(maps_[0]) +
           places_.size() * sizeof(int);
  }

private:
  static constexpr int W = simd::lanes<T>;
  /// The map of one pack.
  /// @param places  the x of the neighbour of each of its elements; -1: none
  LaneMap<T> map_of(std::span<const int> places);

  std::vector<std::ptrdiff_t> begin_; ///< of each row in `maps_`; -1: no maps
  std::vector<PackMaps<T>> maps_;
  std::vector<int> places_;
};

} // namespace dss
