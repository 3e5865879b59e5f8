#pragma once
/// Decomposition: which part of a scene computes which elements (section 5 of the paper, figure 5),
/// and the methods for it.
#include "solver/decomposition/share.hpp"
#include "solver/lattice/lattice.hpp"
#include "solver/model/problem.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// Amount of work for each part. Both lists may be empty; then all entries count as 1.
struct Weights {
  /// Relative speed of each part: a part of twice the speed gets twice the cost.
  std::vector<double> speed;
  std::vector<double> body_cost; ///< relative cost of an element of each body
};

/// Names of the methods: strips (contiguous rows), blocks (recursive bisection across the longest
/// extent, in 2-D and 3-D), metis (k-way on the graph of links with extra links; needs METIS).
std::span<const std::string_view> decomposition_methods();
/// Empty if this build has the method, otherwise why not: "built without METIS".
std::string why_no_decomposition(std::string_view method);

/// Decomposes a problem. The result depends only on the arguments.
/// @throws InputError for an unknown method (with the nearest name), a method that this build
///     lacks, fewer elements (strips: rows) than parts, weights that are not positive or not as
///     many as parts or bodies, or a part without elements
Decomposition decompose(const Problem& problem, std::string_view method, int parts,
                        const Weights& weights = {});

/// Number of own elements of each part.
std::vector<std::size_t> part_elements(const Decomposition& decomposition, const Lattice& lattice);

/// Checks that a decomposition (for example from a file) covers every element of the problem
/// exactly once and leaves no part empty.
/// @throws InputError that says what is wrong and where
void require_fit(const Decomposition& decomposition, const Lattice& lattice);

} // namespace dss
