#pragma once
/// The methods of decomposition, each in a file of its own. Internal to this folder: decompose() checks the arguments
/// and tidies the result.
#include "solver/decomposition/cell_set.hpp"

namespace dss {

/// What is to be divided, and in which proportions.
struct Division {
  const Problem& problem;
  const CellGrid& grid;
  std::vector<double> speed;     ///< of each part, positive
  std::vector<double> body_cost; ///< of an element of each body, positive
  int parts() const { return int(speed.size()); }
};

/// Contiguous rows, each part as near to its share of the cost as whole rows allow. At least as many rows as parts.
std::vector<Share> divide_in_strips(const Division& division);

/// Recursive bisection at planes of cells across the longest extent. At least as many elements as parts.
std::vector<Share> divide_in_blocks(const Division& division);

/// METIS on the graph of links. At least as many elements as parts.
/// @throws InputError if METIS is not there, cannot take a graph of this size, or leaves a part empty
std::vector<Share> divide_by_metis(const Division& division);

/// Ascending by row, then x, as require_fit wants them.
void sort_shares(std::vector<Share>& shares);

/// Of shares that are ascending and do not overlap: lets each begin and end with an element and merges it with the next
/// of the same part across holes.
std::vector<Share> tidy(const std::vector<Share>& shares, const Lattice& lattice);

/// Empty if METIS can be used.
std::string why_no_metis();

} // namespace dss
