#pragma once
/// A part of a decomposed problem, as a problem of its own: its own elements and a halo. The halo
/// is a copy of elements of its neighbours.
#include "solver/decomposition/decomposition.hpp"

#include <cstdint>
#include <vector>

namespace dss {

/// Elements that a part exchanges with one other part. Both lists have local numbers, ascending.
/// One part's `send` is, element by element, the other part's `receive`.
struct Neighbour {
  int part = 0;
  std::vector<std::size_t> send, receive;
};

/// One part and its halo of `depth` layers. `problem` has the elements of both, and the clamps,
/// loads and links on them. Everything else equals the original (bodies, signals, also loads
/// without an element here), so every row is computed as in the original, to the last bit. The
/// lattice keeps the original x, y, z and order of rows. Element numbers are local.
struct Part {
  int index = 0, depth = 0;
  Problem problem;
  std::size_t own_elements = 0;
  /// Layer of each local element. 0: own; k: halo, k links (or holes) away from an own element.
  std::vector<std::uint8_t> layer;
  std::vector<int> global_row;       ///< row of the original lattice, for each local row
  std::vector<Run> runs;             ///< own elements, ascending in both numbers
  std::vector<Neighbour> neighbours; ///< ascending by part
};

/// Position of a neighbour's elements among the rows of a part: all before its own rows (lower),
/// all after them (upper), or among them. An executor may start on one side while messages for the
/// other are on their way.
enum class Side { lower, upper, among };
inline constexpr Side all_sides[] = {Side::lower, Side::upper, Side::among};
Side side_of(const Part& part, const Neighbour& neighbour);

/// Sizes of a part without its sub-problem: for reports, and for simulated clusters, which compute
/// no parts.
struct PartSize {
  std::size_t own_elements = 0;
  int own_rows = 0;                        ///< rows with at least one own element
  std::vector<std::size_t> layer_elements; ///< elements of halo layers 1, 2, ... depth
  /// Elements, own and halo, of the rows whose smallest layer is 0, 1, ... depth. Rows are computed
  /// whole.
  std::vector<std::size_t> row_elements;
  std::size_t inner_elements = 0; ///< own elements in rows that read no halo
  struct Face {
    int part = 0;
    Side side = Side::among;
    std::size_t send = 0, receive = 0; ///< number of elements
    bool operator==(const Face&) const = default;
  };
  std::vector<Face> faces; ///< ascending by part
};

/// Cuts a part out of a problem. Layer k + 1 of the halo holds the cells beside those of layer k in
/// the grid, and the partners by extra links. Holes of a row count as cells, so both sides of a
/// border see the same distance.
/// @param depth  layers of halo, 0 or more
Part make_part(const Problem& problem, const Decomposition& decomposition, int index, int depth);
PartSize part_size(const Problem& problem, const Decomposition& decomposition, int index,
                   int depth);

/// Number of links (with extra links) whose elements belong to different parts.
std::size_t cut_links(const Problem& problem, const Decomposition& decomposition);

} // namespace dss
