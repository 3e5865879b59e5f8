#include "solver/model/thickness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace dss {

std::vector<ThinAxes> thin_axes(const Problem& problem, std::span<const std::size_t> joints) {
  std::vector<ThinAxes> thin(problem.lattice.element_count, 7);
  const auto join = [&](std::size_t i, std::size_t j, int axis) {
    const auto others = ThinAxes(~(1U << axis));
    thin[i] &= others;
    thin[j] &= others;
  };
  problem.lattice.for_each_link(join);
  for (const std::size_t n : joints) {
    const ExtraLink& link = problem.extra_links[n];
    join(link.i, link.j, link.axis);
  }
  return thin;
}

std::vector<std::string> softness_notes(const Problem& problem) {
  const std::vector<ThinAxes> thin = thin_axes(problem);
  std::vector<int> least(problem.bodies.size(), 3); // axes along which an element is thin
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    int& of_body = least[std::size_t(row.body)];
    of_body = std::min(of_body, std::popcount(thin[e]));
  });
  std::vector<std::string> notes;
  for (std::size_t b = 0; b < least.size(); ++b)
    if (problem.bodies[b].has_links_of_beams && least[b] < 2)
      notes.push_back(fmt::format("body \"{}\": links of the law \"material\" are beams, so the "
                                  "body {} as if G were half as "
                                  "large; the law \"solid\" has all of G",
                                  problem.bodies[b].name,
                                  least[b] == 0 ? "shears and twists, where it has several layers,"
                                                : "shears in its plane"));
  return notes;
}

} // namespace dss
