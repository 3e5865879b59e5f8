#pragma once
/// Rounds in which pairs of ranks exchange.
#include <utility>
#include <vector>

namespace dss {

/// Colours the edges of a graph: assigns each edge to a round such that no vertex occurs twice in a
/// round.
/// @param edges  (a, b) with a < b, ascending
/// @return the round of each edge
std::vector<int> colour_edges(const std::vector<std::pair<int, int>>& edges, int vertices);

} // namespace dss
