#pragma once
/// The methods of decomposition, one file each. Internal to this folder: decompose() checks the
/// arguments and tidies the result.
#include "solver/decomposition/cell_set.hpp"

namespace dss {

/// A problem to divide, with the proportions.
struct Division {
  const Problem& problem;
  const CellGrid& grid;
  std::vector<double> speed;     ///< of each part, positive
  std::vector<double> body_cost; ///< of an element of each body, positive
  int parts() const { return int(speed.size()); }
};

/// Contiguous rows. Each part gets its share of the cost as nearly as whole rows allow. Needs at
/// least as many rows as parts.
std::vector<Share> divide_in_strips(const Division& division);

/// Recursive bisection at planes of cells, across the longest extent. Needs at least as many
/// elements as parts.
std::vector<Share> divide_in_blocks(const Division& division);

/// METIS on the graph of links. Needs at least as many elements as parts.
/// @throws InputError if METIS is missing, cannot take a graph of this size, or leaves a part empty
std::vector<Share> divide_by_metis(const Division& division);

/// Sorts by row, then x, as require_fit expects.
void sort_shares(std::vector<Share>& shares);

/// Shortens shares so that each begins and ends with an element, and merges neighbours of the same
/// part across holes. The shares are ascending and do not overlap.
std::vector<Share> tidy(const std::vector<Share>& shares, const Lattice& lattice);

/// Empty if METIS is available, otherwise why not.
std::string why_no_metis();

} // namespace dss
