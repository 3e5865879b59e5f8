#pragma once
/// Runs one problem with any configuration, in this process. Returns the values at the saved times,
/// and the cost.
#include "experiments/run/advise/quantity.hpp"
#include "experiments/run/state/saved_times.hpp"
#include "solver/numerics/method.hpp"
#include "variants/api/api.hpp"

#include <map>
#include <optional>
#include <string>

namespace dss {

/// All choices of a run.
struct Configuration {
  Model model = Model::spatial;
  const Method* method = nullptr; ///< as find_method gives it; dopri5 with rtol
  Precision precision = Precision::f64;
  /// Steps between saved times; with rtol, their length is that of the first attempted step.
  long steps_between = 1;
  std::optional<double> rtol; ///< relative tolerance of adaptive steps
  std::string variant;
  int threads = 1;

  bool operator==(const Configuration&) const = default;
};

/// Result of a run.
struct Observation {
  Observed observed;
  double wall_s = 0;   ///< time in advance() only, as in `dssbench run`
  long steps = 0;      ///< steps done; with adaptive steps, accepted ones
  std::string failure; ///< reason why the run did not reach its end, or empty
};

/// Makes runs of one problem and compares them.
class Workbench {
public:
  /// `problem` must outlive this object.
  Workbench(const Problem& problem, const SavedTimes& times, Quantity quantity)
      : problem_(problem), times_(times), quantity_(quantity) {}

  const Problem& problem() const { return problem_; }
  const SavedTimes& times() const { return times_; }
  Quantity quantity() const { return quantity_; }
  double dt(const Configuration& of) const { return times_.interval() / double(of.steps_between); }
  long steps(const Configuration& of) const { return of.steps_between * times_.count; }
  /// Force evaluations per step. For rkc2 and faber they depend on the step; 0: none would do.
  int stages(const Configuration& of) const;

  Observation run(const Configuration& configuration) const;
  double error(const Observed& expected, const Observed& actual) const {
    return observed_error(problem_, quantity_, expected, actual);
  }
  /// Number of threads that would compute.
  int workers(const Configuration& configuration) const;
  /// Time of a step [s]: the best of up to three timings, each of at least `least_s` [s] or one
  /// step.
  double step_time(const Configuration& configuration, double least_s) const;
  /// Mean time of whole runs [s]; runs are repeated until `least_s` [s] are measured.
  double run_time(const Configuration& configuration, double least_s) const;

private:
  class Process;
  Method method_of(const Configuration& of) const;
  const Method& fitted_method(const Configuration& of) const;
  const Problem& problem_;
  const SavedTimes times_;
  const Quantity quantity_;
  /// By name and steps between saved times.
  mutable std::map<std::pair<std::string_view, long>, Method> fitted_;
};

} // namespace dss
