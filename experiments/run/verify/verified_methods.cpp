#include "experiments/run/verify/verified_methods.hpp"

#include "solver/numerics/stability.hpp"

#include <algorithm>

namespace dss {

bool is_brief(const Method& method) {
  return method.name == "rk4" || method.name == "smoothed_verlet" || method.name == "newmark";
}

double verified_step(const Problem& problem, const Method& method) {
  const double limit = 0.9 * stable_step(problem, method).dt;
  return limit > 0 ? std::min(problem.dt, limit) : problem.dt / 2;
}

} // namespace dss
