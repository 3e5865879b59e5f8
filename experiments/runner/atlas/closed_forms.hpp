#pragma once
/// Exact states of scenes whose motion has a closed form. A study names the form and gives its numbers as expressions over the scene's
/// parameters.
#include "solver/model/problem.hpp"
#include "solver/scene/json/expression.hpp"

#include <string>
#include <vector>

namespace dss {

struct ClosedForm {
  const char* name;
  std::vector<const char*> arguments;
  /// Fields of all elements at time t [s].
  std::vector<double> (*state)(const Problem& problem, const Parameters& arguments, double t);
};

/// flight              ax, ay, az: every element accelerates so, and spins as it began
/// free_top            every element flies and turns free of forces and moments (free_top.hpp)
/// steady_precession   element, precession, spin, pivot_x, pivot_y, pivot_z: a top on a pivot turns about z at the rate `precession` and about its
///                     own z axis at `spin` [rad/s]; the others stay
/// mode                omega, rate: displacements follow x'' + rate x' + omega^2 x = 0 from rest, without rotation
/// step_load           element, omega, static, onset: u_x of one element under a force that jumps on at `onset` and would hold it at `static` [m]
const std::vector<ClosedForm>& closed_forms();

} // namespace dss
