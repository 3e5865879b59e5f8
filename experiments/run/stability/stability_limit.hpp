#pragma once
/// Measures the step at which runs of a variant begin to grow, and compares it with the predicted
/// limit.
#include "solver/numerics/stability.hpp"
#include "variants/api/api.hpp"

#include <string>

namespace dss {

/// A measured limit. The search goes outwards from an exact prediction first, then bisects.
struct LimitMeasurement {
  double dt = 0; ///< largest bounded step [s]; 0 if every tested step grows
  /// Smallest growing step [s], less than limit_resolution above dt; infinite if no tested step
  /// grows.
  double growing_dt = 0;
  long steps = 0; ///< of each run
  int runs = 0;
};

/// The search ends if the two steps are within this relative distance.
constexpr double limit_resolution = 1e-3;
/// Budget of a run in element-steps: about a second.
constexpr double usual_element_steps = 2e7;

/// Measures the limit of the linear motion about rest. Runs start from a tiny random state without
/// loads, in double precision on one thread. A run grows if it becomes non-finite, or if its second
/// half reaches several times the amplitude of its first half. Runs are long enough to show growth
/// of the predicted mode 0.2 % above the prediction, within the budget.
/// @param element_steps  budget of a run
LimitMeasurement measure_limit(const Plugin& plugin, const Problem& problem, const Method& method,
                               const StabilityLimit& predicted,
                               double element_steps = usual_element_steps);

/// Predicted and measured limit of one method, with a verdict.
struct LimitComparison {
  const Method* method = nullptr;
  StabilityLimit predicted;
  LimitMeasurement measured;
  /// "ok"; "failed": an exact prediction is wrong by more than limit_tolerance, or a lower bound is
  /// not safe; "bound": the prediction is a safe lower bound; "unresolved": growth is too slow for
  /// runs of this length; "not measured"
  std::string status;
  std::string reason; ///< reason if not ok, or if there is no limit
  double ratio() const { return measured.dt / predicted.dt; }
};

/// Largest relative error of an exact prediction.
constexpr double limit_tolerance = 0.01;

/// Measures the limit and judges the prediction.
LimitComparison compare_limit(const Plugin& plugin, const Problem& problem, const Method& method,
                              const StabilityLimit& predicted,
                              double element_steps = usual_element_steps);
/// A comparison without a measurement. @param why  reason why it is not measured
LimitComparison predicted_alone(const Method& method, const StabilityLimit& predicted,
                                const std::string& why);

/// "8.83e+05 rad/s, damping ratio 0.42, most in uy of element 57".
std::string mode_text(const StabilityLimit& limit);

} // namespace dss
