#include "experiments/runner/advise/first_steps.hpp"
#include "solver/numerics/stability.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr std::size_t sharp_limit_elements = 3000; ///< a sharp step limit of more takes longer than it may save

/// The largest step, halved from the interval, for which 200 stages suffice.
double fitting_rkc2_step(const Problem& problem, const Method& rkc2, double dt) {
  for (int halvings = 0; halvings < 40; ++halvings, dt /= 2)
    if (stable_step(problem, fitted(problem, rkc2, dt)).dt >= dt) return dt;
  return dt;
}

} // namespace

std::map<std::string_view, long> first_steps(const Problem& problem, const SavedTimes& times) {
  std::vector<const Method*> all;
  for (const Method& method : methods()) all.push_back(&method);
  std::vector<StabilityLimit> limits;
  if (problem.lattice.element_count <= sharp_limit_elements)
    limits = stable_steps(problem, all);
  else
    for (const Method* method : all) limits.push_back(stable_step(problem, *method));
  std::map<std::string_view, long> steps;
  for (std::size_t m = 0; m < all.size(); ++m) {
    if (!(limits[m].dt > 0)) continue;
    const double dt = all[m]->name == "rkc2" ? fitting_rkc2_step(problem, *all[m], times.interval())
                                             : std::min(limits[m].dt, times.interval());
    steps[all[m]->name] = times.steps_between(dt);
  }
  for (const char* needed : {"rk4", "dopri5"})
    if (!steps.contains(needed))
      throw UnstableError(
          fmt::format("{}: {} is stable with no step at all, so nothing can be advised", problem.name, needed));
  return steps;
}

} // namespace dss
