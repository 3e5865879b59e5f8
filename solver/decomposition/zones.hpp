#pragma once
/// Zones of a part (figure 5 of the paper): own elements, layers of the halo, and exchanges with
/// each neighbour. Internal to this folder.
#include "solver/decomposition/cell_set.hpp"

#include <optional>

namespace dss {

/// All sets contain present cells only.
struct Zones {
  CellSet own, all;            ///< own elements; own and halo
  std::vector<CellSet> layers; ///< layers[k - 1] is layer k of the halo
  struct Face {
    int part = 0;
    CellSet send, receive;
  };
  std::vector<Face> faces; ///< ascending by part
};

/// @param index  a part of the decomposition, which fits the grid
/// @param depth  layers of halo
Zones find_zones(const CellGrid& grid, const Decomposition& decomposition, int index, int depth);

/// The elements of a set, numbered from 0 in their order, with their numbers in the whole problem.
class Addresses {
public:
  Addresses(const CellGrid& grid, const CellSet& set);

  const std::vector<Run>& runs() const { return runs_; }
  std::size_t element_count() const {
    return runs_.empty() ? 0 : runs_.back().local + runs_.back().count;
  }
  /// Local number of an element; nothing if it is outside the set.
  std::optional<std::size_t> local(std::size_t global) const;
  /// Runs of a subset, in the local numbers of this set.
  std::vector<Run> runs_of(const CellGrid& grid, const CellSet& subset) const;

private:
  std::vector<Run> runs_; ///< ascending in both numbers, each as long as possible
};

} // namespace dss
