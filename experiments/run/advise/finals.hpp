#pragma once
/// The final round of advice. It runs the cheapest candidates and the paper's configuration as a
/// whole, in turn.
#include "experiments/run/advise/advice.hpp"
#include "experiments/run/advise/step_costs.hpp"

namespace dss {

/// Measures the finalists.
class Finals {
public:
  /// @param advice  candidates to measure; their times are filled in
  /// @param left_s  time left in the budget [s]
  Finals(const Workbench& bench, StepCosts& costs, Advice& advice, double left_s)
      : bench_(bench), costs_(costs), advice_(advice), left_s_(left_s) {}

  /// Measures the finalists on every variant and number of threads near the best, and keeps the
  /// fastest of each. Also measures the paper's run and its error.
  void measure();

private:
  struct Entry {
    Candidate* candidate; ///< null: the paper's run
    Configuration configuration;
    std::vector<double> times_s;
    double best_s() const; ///< shortest time: other load only makes runs slower
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
