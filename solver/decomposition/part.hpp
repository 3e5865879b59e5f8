#pragma once
/// A part of a decomposed problem: its own elements and a halo of its neighbours' elements, as a problem of its own.
#include "solver/decomposition/decomposition.hpp"

#include <cstdint>
#include <vector>

namespace dss {

/// What a part exchanges with one other part. Both lists are ascending and have local numbers; what one part sends is, element by
/// element, what the other receives.
struct Neighbour {
  int part = 0;
  std::vector<std::size_t> send, receive;
};

/// Own elements that follow one another both here and in the original problem: the addresses of a part in the original model.
struct Run {
  std::size_t local = 0, global = 0, count = 0;
};

/// One part and its halo of `depth` layers. `problem` has the elements of both, the clamps, loads and links on them, and all else
/// (bodies, signals, loads even if no element here carries them) as the original, so that row by row and to the last bit it is computed
/// as there. Its lattice has the original's x, y, z; rows keep their order. Element numbers are local.
struct Part {
  int index = 0, depth = 0;
  Problem problem;
  std::size_t own_elements = 0;
  std::vector<std::uint8_t> layer;   ///< of each local element: 0 own, k: halo, k links (or holes) away from an own one
  std::vector<int> global_row;       ///< row of the original lattice, of each local row
  std::vector<Run> runs;             ///< own elements, ascending in both numbers
  std::vector<Neighbour> neighbours; ///< ascending by part
};

/// Where a neighbour's elements lie among the rows of a part: all before its own rows, all behind them, or among them.
/// An executor may start on one side while messages from the other are under way.
enum class Side { lower, upper, among };
inline constexpr Side all_sides[] = {Side::lower, Side::upper, Side::among};
Side side_of(const Part& part, const Neighbour& neighbour);

/// Sizes alone, without the sub-problem: for reports and for simulated clusters, whose parts are not computed.
struct PartSize {
  std::size_t own_elements = 0;
  int own_rows = 0;                        ///< rows with an own element
  std::vector<std::size_t> layer_elements; ///< elements of halo layer 1, 2, ... depth
  /// Elements, own and halo, of the rows whose least layer is 0, 1, ... depth. Rows are computed whole.
  std::vector<std::size_t> row_elements;
  std::size_t inner_elements = 0; ///< of own rows that read no halo
  struct Face {
    int part = 0;
    Side side = Side::among;
    std::size_t send = 0, receive = 0; ///< elements
    bool operator==(const Face&) const = default;
  };
  std::vector<Face> faces; ///< ascending by part
};

/// Cuts a part out of a problem. The halo's layer k + 1 are the cells beside those of layer k in the grid (holes of a row count as cells,
/// so that both sides of a border see the same distance) and the partners of their extra links.
/// @param depth  layers of halo, 0 or more
Part make_part(const Problem& problem, const Decomposition& decomposition, int index, int depth);
PartSize part_size(const Problem& problem, const Decomposition& decomposition, int index, int depth);

/// Links (extra links included) whose elements belong to different parts.
std::size_t cut_links(const Problem& problem, const Decomposition& decomposition);

} // namespace dss
