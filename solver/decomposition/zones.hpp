#pragma once
/// The zones of a part (figure 5 of the paper): its own elements, the layers of its halo, and what it exchanges with
/// whom. Internal to this folder.
#include "solver/decomposition/cell_set.hpp"
#include "solver/decomposition/part.hpp"

#include <optional>

namespace dss {

/// All sets are of present cells.
struct Zones {
  CellSet own, all;            ///< own; own and halo
  std::vector<CellSet> layers; ///< of the halo: [k - 1] is layer k
  struct Face {
    int part = 0;
    CellSet send, receive;
  };
  std::vector<Face> faces; ///< ascending by part
};

/// @param index  a part of the decomposition, which fits the grid
Zones find_zones(const CellGrid& grid, const Decomposition& decomposition, int index, int depth);

/// The elements of a set, numbered from 0 in their order: their numbers in the whole problem and back.
class Addresses {
public:
  Addresses(const CellGrid& grid, const CellSet& set);

  const std::vector<Run>& runs() const { return runs_; }
  std::size_t element_count() const { return runs_.empty() ? 0 : runs_.back().local + runs_.back().count; }
  /// Nothing for an element outside the set.
  std::optional<std::size_t> local(std::size_t global) const;
  /// Runs of a subset, in this set's local numbers.
  std::vector<Run> runs_of(const CellGrid& grid, const CellSet& subset) const;

private:
  std::vector<Run> runs_; ///< ascending in both numbers, as long as they can be
};

} // namespace dss
