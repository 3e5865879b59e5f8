#pragma once
/// Rounds in which the ranks of a graph meet, two by two.
#include <utility>
#include <vector>

namespace dss {

/// Round in which each edge of a graph is used, so that no vertex is used twice in a round. Edges (a, b), a < b,
/// ascending.
std::vector<int> colour_edges(const std::vector<std::pair<int, int>>& edges, int vertices);

} // namespace dss
