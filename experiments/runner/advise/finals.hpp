#pragma once
/// The last round of advice: whole runs of those that may be the cheapest, and of the paper's configuration, in turn.
#include "experiments/runner/advise/advise.hpp"
#include "experiments/runner/advise/step_costs.hpp"

namespace dss {

class Finals {
public:
  /// Of `advice`, which it fills in. @param left_s  of the budget [s]
  Finals(const Workbench& bench, StepCosts& costs, Advice& advice, double left_s)
      : bench_(bench), costs_(costs), advice_(advice), left_s_(left_s) {}

  /// Measures the finalists on every variant and number of threads near the best, keeps the fastest of each, and measures the paper's run and its error.
  void measure();

private:
  struct Entry {
    Candidate* candidate; ///< null: the paper's run
    Configuration configuration;
    std::vector<double> times_s;
    double best_s() const; ///< a shared machine is never too fast
  };
  void enter();
  void run_rounds();
  void take();
  void look_at_paper();

  const Workbench& bench_;
  StepCosts& costs_;
  Advice& advice_;
  double left_s_;
  std::vector<Entry> entries_;
};

} // namespace dss
