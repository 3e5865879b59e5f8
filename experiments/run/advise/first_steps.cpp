#include "experiments/run/advise/first_steps.hpp"
#include "solver/numerics/stability.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// a sharp limit for a hundred elements takes some seconds
constexpr std::size_t sharp_limit_elements = 32;

/// Largest step of rkc2: the interval is halved until the bound shows that some number of stages is
/// stable.
double fitting_rkc2_step(const Problem& problem, double dt) {
  for (int halvings = 0; halvings < 40 && !has_stages(problem, dt); ++halvings) dt /= 2;
  return dt;
}

} // namespace

bool has_stages(const Problem& problem, double dt) {
  constexpr int most_stages = 200, tried = 12; // as in fitted
  const double damping = stable_step(problem, rkc2(2)).damping;
  int least = 2;
  while (least <= most_stages && rkc2(least).real_limit < dt * damping) ++least;
  for (int stages = least; stages < least + tried && stages <= most_stages; ++stages)
    if (stable_step(problem, rkc2(stages)).dt >= dt) return true;
  return false;
}

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
    const double dt = all[m]->name == "rkc2" ? fitting_rkc2_step(problem, times.interval())
                                             : std::min(limits[m].dt, times.interval());
    steps[all[m]->name] = times.steps_between(dt);
  }
  for (const char* needed : {"rk4", "dopri5"})
    if (!steps.contains(needed))
      throw UnstableError(fmt::format(
          "{}: {} is stable with no step at all, so nothing can be advised", problem.name, needed));
  return steps;
}

} // namespace dss
