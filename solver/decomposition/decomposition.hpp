#pragma once
/// Which part of a scene computes which elements (section 5 of the paper, figure 5), and the methods that decide it.
#include "solver/lattice/lattice.hpp"
#include "solver/model/problem.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// The cells x_begin <= x < x_end of a row of the lattice; holes among them belong to nobody.
struct Segment {
  int row = 0, x_begin = 0, x_end = 0;
  bool operator==(const Segment&) const = default;
};

/// A segment and the part that owns its elements.
struct Share {
  Segment segment;
  int part = 0;
  bool operator==(const Share&) const = default;
};

/// Every element belongs to exactly one part. Shares are ascending by row, then x; neighbouring segments of one part are merged.
struct Decomposition {
  std::string method; ///< "strips", "blocks", "metis", or what a file says
  int parts = 1;
  std::vector<Share> shares;
};

/// How much work a part gets. Both may be empty: then all count the same.
struct Weights {
  std::vector<double> speed;     ///< of each part, relative; a part of twice the speed gets twice the cost
  std::vector<double> body_cost; ///< of an element of each body, relative
};

/// Names of the methods: strips (contiguous rows), blocks (recursive bisection across the longest extent: 2-D and 3-D), metis (k-way
/// on the graph of links, extra links included; needs METIS).
std::span<const std::string_view> decomposition_methods();
/// Empty if the method can be used in this build, else why not: "built without METIS".
std::string why_no_decomposition(std::string_view method);

/// Decomposes a problem; the result depends on nothing but the arguments.
/// @throws InputError for an unknown method (naming the nearest), one that this build lacks, fewer elements (strips: rows) than parts,
/// weights that are not positive or not as many as parts or bodies, or a part that would be left without elements
Decomposition decompose(const Problem& problem, std::string_view method, int parts, const Weights& weights = {});

/// Own elements of each part.
std::vector<std::size_t> part_elements(const Decomposition& decomposition, const Lattice& lattice);

/// Checks that a decomposition (from a file, say) covers every element of the problem exactly once and leaves no part empty.
/// @throws InputError: what is wrong, where
void require_fit(const Decomposition& decomposition, const Lattice& lattice);

} // namespace dss
