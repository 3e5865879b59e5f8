#include "experiments/run/advise/first_steps.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/faber.hpp"
#include "solver/numerics/stability.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// a sharp limit for a hundred elements takes some seconds
constexpr std::size_t sharp_limit_elements = 32;

/// True if some number of rkc2 stages is stable with a step dt [s] by the bound of stable_step.
/// Then `fitted` finds it without computing a sharp limit.
bool has_stages(const Problem& problem, double dt) {
  constexpr int most_stages = 200, tried = 12; // as in fitted
  const double damping = stable_step(problem, rkc2(2)).damping;
  int least = 2;
  while (least <= most_stages && rkc2(least).real_limit < dt * damping) ++least;
  for (int stages = least; stages < least + tried && stages <= most_stages; ++stages)
    if (stable_step(problem, rkc2(stages)).dt >= dt) return true;
  return false;
}

/// Steps between saved times of a fitted method: twice as many until it has stages. 0: it never
/// has.
long fitting_steps(const Problem& problem, const Method& method, const SavedTimes& times) {
  const int most_halvings = method.is_exponential ? 12 : 40;
  long steps = 1;
  // A spectrum takes longer to find than its bound, and no fewer stages than its phase fit.
  const double phase =
      method.is_exponential ? spectrum_bound(problem).omega_max * times.interval() : 0;
  while (phase / double(steps) > most_faber_stages) steps *= 2;
  for (int halvings = 0; halvings < most_halvings; ++halvings, steps *= 2)
    if (fitted_or_none(problem, method, times.interval() / double(steps), steps * times.count)
            .stages > 0)
      return steps;
  return 0;
}

/// Whether an exponential method can compute a problem with one of its models.
bool has_exponential(const Problem& problem, const Method& method) {
  return std::ranges::any_of(models, [&](Model model) {
    return why_not(model, problem).empty() &&
           why_not_exponential(method, problem, model, Precision::f64, Rotation::quaternion)
               .empty();
  });
}

} // namespace

Method fitted_or_none(const Problem& problem, const Method& method, double dt, long steps) {
  Method none = method;
  none.stages = 0;
  if (method.is_exponential) {
    if (!why_not_polynomial(problem, dt, steps).empty()) return none;
  } else if (!has_stages(problem, dt)) {
    return none;
  }
  try {
    return fitted(problem, method, dt);
  } catch (const InputError&) {
    return none;
  }
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
    const long between = all[m]->is_fitted()
                             ? fitting_steps(problem, *all[m], times)
                             : times.steps_between(std::min(limits[m].dt, times.interval()));
    if (between > 0) steps[all[m]->name] = between;
  }
  const Method& faber = *find_method("faber");
  if (const long between =
          has_exponential(problem, faber) ? fitting_steps(problem, faber, times) : 0;
      between > 0)
    steps[faber.name] = between;
  for (const char* needed : {"rk4", "dopri5"})
    if (!steps.contains(needed))
      throw UnstableError(fmt::format(
          "{}: {} is stable with no step at all, so nothing can be advised", problem.name, needed));
  return steps;
}

} // namespace dss
