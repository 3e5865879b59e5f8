#pragma once
/// Jobs on clusters that we do not have: SimGrid runs the exchange code of variants/mpi, computation is injected.
#include "solver/decomposition/part.hpp"
#include "solver/model/model.hpp"
#include "solver/numerics/method.hpp"
#include "variants/mpi/simulated/plan.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// What is simulated.
struct SimulatedProblem {
  const Problem& problem;
  const Method& method;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
};

/// The network and what became of a step on it.
struct SimulatedRun {
  std::string halo; ///< that ran
  double step_s = 0, communication_s_per_step = 0;
  double messages_per_step = 0, bytes_per_step = 0;
  double latency_s = 0, seconds_a_byte = 0; ///< by ping-pong in the simulation
  nlohmann::ordered_json predicted_step_s;  ///< by strategy
  nlohmann::ordered_json tried_step_s;      ///< of what was run: auto tries those that might be the fastest
};

/// Empty, or why nothing can be simulated here: "built without SimGrid".
std::string why_no_simulation();

/// Speed of one core of this machine on parts of this decomposition: the largest part is computed, or one as large as a
/// trial may be.
NodeSpeed own_speed(const SimulatedProblem& what, const Decomposition& decomposition);
/// Speed of a node that takes so many seconds for a step of so many elements, whatever the schedule.
NodeSpeed given_speed(const std::string& name, double element_steps_per_s, const Method& method);

/// What each strategy (but those through shared memory: every rank is a node) computes and exchanges.
/// @param halo  strategy to run, or "auto"
SimulationPlan make_plan(const SimulatedProblem& what, const Decomposition& decomposition, const NodeSpeed& speed,
                         const std::string& halo, int steps);

/// Name of a platform made of what messages between two ranks cost on this machine, by ping-pong.
inline constexpr const char* host_platform = "this_host";

/// A platform file: by its name in experiments/platforms, by its path, or made for this host.
class Platform {
public:
  /// @throws InputError naming the nearest; for this host, if ranks cannot run here
  explicit Platform(const std::string& name_or_path);
  /// Whether a name is known, without measuring anything. @throws InputError as above
  static void require_known(const std::string& name_or_path);
  /// Of all that are shipped, and this host.
  static std::vector<std::string> names();
  const std::string& path() const { return path_; }

private:
  std::string path_;
  std::shared_ptr<const void> temporary_; ///< removes a file that was made
};

/// Runs a plan on a platform. @throws InputError with what SimGrid said if it fails
SimulatedRun simulate(const SimulationPlan& plan, const std::string& platform);

} // namespace dss
