#pragma once
/// What the pressures of a link's two elements add to its stiffness at most.
#include "solver/model/problem.hpp"

#include <algorithm>

namespace dss {

/// Stiffness that links get from the pressures of their elements: of the gap along the link [N/m],
/// and of the turn about each axis [N m/rad].
struct PressedLink {
  double normal = 0;
  Vec3 turn{};
};

/// An upper bound for the links of a body along an axis. The square of a sum of n terms is at most
/// n times the sum of their squares. An element has S = 1/2 the sum of at most six strains, and C =
/// 1/2 the sum of at most four curvatures (solver/reference/pressure.hpp); a link has two elements.
inline PressedLink largest_pressed_link(const Body& body, int axis) {
  const auto a = std::size_t(axis);
  const double area_over_length = body.edge[(a + 1) % 3] * body.edge[(a + 2) % 3] / body.edge[a];
  PressedLink most;
  for (const ElementPressure& pressure : body.pressures) {
    most.normal = std::max(most.normal, 3 * pressure.volume * area_over_length);
    for (std::size_t o = 0; o < 3; ++o)
      if (o != a)
        most.turn[3 - o - a] =
            std::max(most.turn[3 - o - a], 2 * pressure.bending[o] * area_over_length);
  }
  return most;
}

} // namespace dss
