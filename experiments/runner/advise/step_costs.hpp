#pragma once
/// What a step costs here: short timings, each made once, by model, precision, method, variant and threads.
#include "experiments/runner/advise/workbench.hpp"

#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace dss {

/// Where a configuration runs.
struct Target {
  std::string variant;
  int threads = 1;
};

/// Usable variants of this CPU, the fastest first; or those named, each of which is opened. @throws InputError for one that cannot run here
std::vector<std::string> advised_variants(const std::vector<std::string>& named);

class StepCosts {
public:
  /// Times the spatial model in f64 on every variant, and keeps those within twice the fastest; more threads are kept as long as that
  /// model, which has the most work to share, gains by them.
  /// @param base  spatial, f64: its method, steps; variant and threads do not matter
  StepCosts(const Workbench& bench, const Configuration& base, const std::vector<std::string>& variants,
            int most_threads);

  /// Sets variant and threads to the fastest of the configuration's model and precision.
  Configuration placed(Configuration configuration);
  /// All within `share` of the fastest, the fastest first.
  std::vector<Target> near_best(const Configuration& configuration, double share);
  /// Predicted time of a run of fixed steps [s], on its variant and threads.
  double run_time(const Configuration& configuration);

private:
  using Key = std::tuple<Model, Precision, const Method*, std::string, int>;
  double evaluation_time(const Configuration& configuration);

  const Workbench& bench_;
  const Configuration base_;
  std::vector<Target> targets_;
  std::map<Key, double> evaluation_s_;
};

} // namespace dss
