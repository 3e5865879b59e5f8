#pragma once
/// Costs of a step on this machine, from short timings. Each model, precision, method, variant and
/// number of threads is timed once.
#include "experiments/run/advise/workbench.hpp"

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

/// Variants of this CPU that can run a problem, the fastest first; or the named ones, which are
/// opened.
/// @throws InputError for a variant that cannot run here
std::vector<std::string> advised_variants(const Problem& problem,
                                          const std::vector<std::string>& named);

/// Times steps and predicts the time of runs.
class StepCosts {
public:
  /// Times the spatial model in f64 on every variant and keeps those within twice the fastest time.
  /// Then adds threads as long as they make this model faster. This model has the most work to
  /// share.
  /// @param base  spatial, f64, with its method and steps; its variant and threads are ignored
  StepCosts(const Workbench& bench, const Configuration& base,
            const std::vector<std::string>& variants, int most_threads);

  /// Sets the variant and threads that are fastest for the configuration's model and precision.
  Configuration placed(Configuration configuration);
  /// All targets whose time is within `share` times the fastest, the fastest first.
  std::vector<Target> near_best(const Configuration& configuration, double share);
  /// Predicted time of a run with fixed steps [s], on the configuration's variant and threads.
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
