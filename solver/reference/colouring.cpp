#include "solver/reference/colouring.hpp"

#include <algorithm>
#include <limits>

namespace dss::reference {

/// With the neighbours of neighbours: the pressure of a neighbour depends on all of its links.
static std::vector<std::vector<std::size_t>>
second_neighbourhoods(const std::vector<std::vector<std::size_t>>& first) {
  std::vector<std::vector<std::size_t>> of = first;
  for (std::size_t e = 0; e < of.size(); ++e)
    for (const std::size_t near : first[e])
      for (const std::size_t other : first[near])
        if (std::ranges::find(of[e], other) == of[e].end()) of[e].push_back(other);
  return of;
}

std::vector<std::vector<std::size_t>> neighbourhoods(const Problem& problem) {
  std::vector<std::vector<std::size_t>> of(problem.lattice.element_count);
  for (std::size_t e = 0; e < of.size(); ++e) of[e] = {e};
  const auto join = [&of](std::size_t i, std::size_t j) {
    if (std::ranges::find(of[i], j) != of[i].end()) return;
    of[i].push_back(j);
    of[j].push_back(i);
  };
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int) { join(i, j); });
  for (const ExtraLink& extra : problem.extra_links) join(extra.i, extra.j);
  return problem.has_pressure() ? second_neighbourhoods(of) : of;
}

std::vector<std::vector<std::size_t>>
colour_groups(const std::vector<std::vector<std::size_t>>& neighbourhoods) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> colour(neighbourhoods.size(), none);
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> taken_by; // for each colour, the last element that must not have it
  for (std::size_t e = 0; e < colour.size(); ++e) {
    for (const std::size_t near : neighbourhoods[e])
      for (const std::size_t other : neighbourhoods[near])
        if (colour[other] != none) taken_by[colour[other]] = e;
    const auto free =
        std::ranges::find_if(taken_by, [e](std::size_t element) { return element != e; });
    colour[e] = std::size_t(free - taken_by.begin());
    if (free == taken_by.end()) {
      taken_by.push_back(none);
      groups.emplace_back();
    }
    groups[colour[e]].push_back(e);
  }
  return groups;
}

} // namespace dss::reference
