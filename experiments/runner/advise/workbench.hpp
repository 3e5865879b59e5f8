#pragma once
/// Runs of one problem with any configuration, in this process: what they show at the saved times, and what they cost.
#include "experiments/runner/advise/quantity.hpp"
#include "experiments/runner/precision/saved_times.hpp"
#include "solver/numerics/method.hpp"
#include "variants/api.hpp"

#include <map>
#include <optional>
#include <string>

namespace dss {

/// Everything of a run that is a choice.
struct Configuration {
  Model model = Model::spatial;
  const Method* method = nullptr; ///< as find_method gives it; of rtol dopri5
  Precision precision = Precision::f64;
  long steps_between = 1; ///< from one saved time to the next; with rtol their length is that of the first step tried
  std::optional<double> rtol; ///< of adaptive steps
  std::string variant;
  int threads = 1;

  bool operator==(const Configuration&) const = default;
};

/// What a run came to.
struct Observation {
  Observed observed;
  double wall_s = 0;   ///< in advance() alone, as `dssbench run` has it
  long steps = 0;      ///< done; of adaptive steps those accepted
  std::string failure; ///< empty, or why it did not reach its end
};

class Workbench {
public:
  /// `problem` must outlive it.
  Workbench(const Problem& problem, const SavedTimes& times, Quantity quantity)
      : problem_(problem), times_(times), quantity_(quantity) {}

  const Problem& problem() const { return problem_; }
  const SavedTimes& times() const { return times_; }
  Quantity quantity() const { return quantity_; }
  double dt(const Configuration& of) const { return times_.interval() / double(of.steps_between); }
  long steps(const Configuration& of) const { return of.steps_between * times_.count; }
  /// Force evaluations of a step: of rkc2 they follow from the step. 0: it has no number of stages for that
  int stages(const Configuration& of) const;

  Observation run(const Configuration& configuration) const;
  double error(const Observed& expected, const Observed& actual) const {
    return observed_error(problem_, quantity_, expected, actual);
  }
  /// Threads that would compute.
  int workers(const Configuration& configuration) const;
  /// Time of a step [s], the best of three short timings, each of `least_s` [s] or one step.
  double step_time(const Configuration& configuration, double least_s) const;
  /// Mean time of whole runs [s], so many that `least_s` [s] are measured.
  double run_time(const Configuration& configuration, double least_s) const;

private:
  class Process;
  Method method_of(const Configuration& of) const;
  const Problem& problem_;
  const SavedTimes times_;
  const Quantity quantity_;
  mutable std::map<long, int> rkc2_stages_; ///< by steps between saved times
};

} // namespace dss
