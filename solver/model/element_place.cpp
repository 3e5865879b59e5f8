#include "solver/model/element_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {

NearestPlace nearest_place(const Problem& problem, int body, const Vec3& point) {
  const Vec3& edge = problem.bodies[std::size_t(body)].edge;
  const double rounding = 1e-9 * *std::ranges::min_element(edge);
  NearestPlace nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (row.body != body) return;
    const Vec3 centre = rest_position(problem, row, x);
    Vec3 arm{}, off{};
    for (std::size_t a = 0; a < 3; ++a) {
      arm[a] = std::clamp(point[a] - centre[a], -edge[a] / 2, edge[a] / 2);
      off[a] = point[a] - centre[a] - arm[a];
    }
    const double distance = std::hypot(off[0], off[1], off[2]);
    if (distance < nearest.distance - rounding)
      nearest = {e, {x, row.y, row.z}, centre, arm, distance};
  });
  return nearest;
}

} // namespace dss
