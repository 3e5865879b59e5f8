#include "variants/cost/rounds.hpp"

#include <set>

namespace dss {

std::vector<int> colour_edges(const std::vector<std::pair<int, int>>& edges, int vertices) {
  std::vector<std::set<int>> used(static_cast<std::size_t>(vertices));
  std::vector<int> rounds;
  for (const auto& [a, b] : edges) {
    int round = 0;
    while (used[std::size_t(a)].contains(round) || used[std::size_t(b)].contains(round)) ++round;
    used[std::size_t(a)].insert(round);
    used[std::size_t(b)].insert(round);
    rounds.push_back(round);
  }
  return rounds;
}

} // namespace dss
