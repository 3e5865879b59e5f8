#pragma once
/// Exact states of scenes whose motion has a closed form. A study names the form and gives its
/// arguments as expressions over the scene's parameters.
#include "solver/model/problem.hpp"
#include "solver/scene/expression.hpp"

#include <string>
#include <vector>

namespace dss {

/// One closed form and the names of its arguments.
struct ClosedForm {
  const char* name;
  std::vector<const char*> arguments;
  /// Fields of all elements at time t [s], 13 numbers per element.
  std::vector<double> (*state)(const Problem& problem, const Parameters& arguments, double t);
};

/// The closed forms and their arguments:
/// - flight (ax, ay, az): every element has this acceleration [m/s^2] and keeps its initial spin
/// - free_top (none): every element moves without forces and moments (free_top.hpp)
/// - steady_precession (element, precession, spin, pivot_x, pivot_y, pivot_z): a top on a pivot
/// turns about z with the rate `precession` and about its own z axis with `spin` [rad/s]; the other
/// elements stay
/// - mode (omega, rate): displacements follow x'' + rate x' + omega^2 x = 0 from rest, without
/// rotation
/// - step_load (element, omega, static, onset): u_x of one element under a force that starts
/// suddenly at `onset` [s] and has the static displacement `static` [m]
const std::vector<ClosedForm>& closed_forms();

} // namespace dss
