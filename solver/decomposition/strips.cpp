/// Strips: the rows of the lattice in their order, cut into contiguous ranges.
#include "solver/decomposition/methods.hpp"

#include <numeric>

namespace dss {

std::vector<Share> divide_in_strips(const Division& division) {
  const int rows = int(division.grid.lattice().rows.size()), parts = division.parts();
  std::vector<double> cost_before(std::size_t(rows) + 1, 0);
  for (int r = 0; r < rows; ++r)
    cost_before[std::size_t(r) + 1] =
        cost_before[std::size_t(r)] +
        double(division.grid.elements_of(r)) *
            division.body_cost[std::size_t(division.grid.row(r).body)];
  const double all_speed = std::accumulate(division.speed.begin(), division.speed.end(), 0.0);
  std::vector<Share> shares;
  double speed = 0;
  for (int part = 0, begin = 0; part < parts; ++part) {
    speed += division.speed[std::size_t(part)];
    const double wanted = cost_before.back() * speed / all_speed;
    const auto above = std::lower_bound(cost_before.begin(), cost_before.end(), wanted);
    int end = int(std::min(above, cost_before.end() - 1) - cost_before.begin());
    if (end > 0 &&
        wanted - cost_before[std::size_t(end) - 1] <= cost_before[std::size_t(end)] - wanted)
      --end;
    const int rows_after = parts - part - 1; // at least one for each later part
    end = part + 1 == parts ? rows : std::clamp(end, begin + 1, rows - rows_after);
    for (; begin < end; ++begin)
      shares.push_back(
          {{begin, division.grid.row(begin).x_begin, division.grid.row(begin).x_end}, part});
  }
  return shares;
}

} // namespace dss
