#pragma once
/// The step at which runs of a variant begin to grow, measured, beside the step that is predicted.
#include "solver/numerics/stability.hpp"
#include "variants/api.hpp"

#include <string>

namespace dss {

/// Found by blow-up: outwards from the prediction if it is exact, then by bisection.
struct LimitMeasurement {
  double dt = 0;         ///< largest step found bounded [s]; 0 if every step tried let the run grow
  double growing_dt = 0; ///< smallest step found to grow, less than limit_resolution above [s]; infinite if none did
  long steps = 0;        ///< of each run
  int runs = 0;
};

/// The search ends when the two steps are this near, relative.
constexpr double limit_resolution = 1e-3;
/// Budget of a run: a second or so.
constexpr double usual_element_steps = 2e7;

/// Runs about rest, from a tiny random state without loads, so that motion is linear; in double precision on one thread.
/// A run grows if it leaves the finite numbers, or its second half reaches several times what its first half does. Runs
/// are so long that the predicted mode is seen to grow at 0.2 % above the prediction, or as long as the budget allows.
LimitMeasurement measure_limit(const Plugin& plugin, const Problem& problem, const Method& method,
                               const StabilityLimit& predicted, double element_steps = usual_element_steps);

/// Both for one method, judged.
struct LimitComparison {
  const Method* method = nullptr;
  StabilityLimit predicted;
  LimitMeasurement measured;
  std::string
      status; ///< "ok"; "failed": an exact prediction is missed by more than limit_tolerance, or a bound was not
              ///< safe; "unresolved": growth is too slow for runs of this length; "not measured"
  std::string reason; ///< for what is not ok, and where there is no limit
  double ratio() const { return measured.dt / predicted.dt; }
};

constexpr double limit_tolerance = 0.01;

LimitComparison compare_limit(const Plugin& plugin, const Problem& problem, const Method& method,
                              const StabilityLimit& predicted, double element_steps = usual_element_steps);
/// Without a measurement; `why` not.
LimitComparison predicted_alone(const Method& method, const StabilityLimit& predicted, const std::string& why);

/// "8.83e+05 rad/s, damping ratio 0.42, most in uy of element 57".
std::string mode_text(const StabilityLimit& limit);

} // namespace dss
