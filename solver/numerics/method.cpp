#include "solver/numerics/method.hpp"

#include <algorithm>
#include <limits>

namespace dss {
namespace {

// Made on first use: methods() may be asked for before the objects of this file are.

/// Classical RK4 without a running sum (DESIGN.md section 3): y1 = y + h/2 k1, y2 = y + h/2 k2, y3 = y + h k3,
/// y(n+1) = (y1 + 2 y2 + y3 - y)/3 + h/6 k4. Its limits are the roots of |R(z)| = 1, R(z) = 1 + z + z^2/2 + z^3/6 +
/// z^4/24.
Method rk4() {
  constexpr double third = 1.0 / 3, sixth = 1.0 / 6;
  return {.name = "rk4",
          .family = Method::Family::runge_kutta,
          .order = 4,
          .stages = 4,
          .node = {0, 0.5, 0.5, 1},
          .beta = {0.5, 0.5, 1, sixth},
          .alpha = {{0}, {0, 0}, {0, 0, 0}, {0, third, 2 * third, third}},
          .imaginary_limit = 2.8284271247461903,
          .real_limit = 2.785293563405282,
          .is_symplectic = false,
          .keeps_energy_bounded = false,
          .note = "classical fourth-order Runge-Kutta; four force evaluations a step"};
}

Method velocity_verlet() {
  return {.name = "velocity_verlet",
          .family = Method::Family::leapfrog,
          .order = 2,
          .stages = 1,
          .node = {0},
          .beta = {1},
          .alpha = {{0}},
          .imaginary_limit = 2,
          .real_limit = 1,
          .is_symplectic = true,
          .keeps_energy_bounded = true,
          .note =
              "one force evaluation a step; damping and gyroscopic terms see a predicted velocity, which lowers the "
              "step limit of damped problems"};
}

Method implicit_midpoint() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {.name = "implicit_midpoint",
          .family = Method::Family::implicit_midpoint,
          .order = 2,
          .stages = 1,
          .node = {0.5},
          .beta = {1},
          .alpha = {{0}},
          .imaginary_limit = infinity,
          .real_limit = infinity,
          .is_symplectic = true,
          .keeps_energy_bounded = true,
          .note = "solves the equations of each step to rounding by Newton's iteration; any step is stable, but modes "
                  "that it does not resolve are slowed down and hardly damped"};
}

} // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> all = {rk4(), velocity_verlet()};
  return all;
}

const std::vector<Method>& implicit_methods() {
  static const std::vector<Method> all = {implicit_midpoint()};
  return all;
}

const Method* find_method(std::string_view name) {
  for (const std::vector<Method>* all : {&methods(), &implicit_methods()})
    if (const auto found = std::ranges::find(*all, name, &Method::name); found != all->end()) return &*found;
  return nullptr;
}

} // namespace dss
