#pragma once
/// Simulates jobs on clusters. SimGrid runs the exchange code of variants/mpi; computing time is
/// injected.
#include "kernels/model.hpp"
#include "solver/decomposition/part.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/scene.hpp"
#include "variants/mpi/simulated/plan.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace dss {

/// The computation that is simulated.
struct SimulatedProblem {
  const Problem& problem;
  const Method& method;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
};

/// The computation of a scene: its own method and model, in double precision.
SimulatedProblem simulated_problem(const Scene& scene);
/// Names of the strategies that a simulation has: those that messages alone carry out, and auto.
std::vector<std::string> simulated_halos();

/// The simulated network, and the time of a step on it.
struct SimulatedRun {
  std::string halo; ///< halo strategy that ran
  double step_s = 0, communication_s_per_step = 0;
  double messages_per_step = 0, bytes_per_step = 0;
  double latency_s = 0, seconds_a_byte = 0; ///< measured by ping-pong in the simulation
  nlohmann::ordered_json predicted_step_s;  ///< by strategy
  /// By strategy, for those that ran: auto tries those that might be the fastest.
  nlohmann::ordered_json tried_step_s;
};

/// Reason why nothing can be simulated here, "built without SimGrid"; empty if it can.
std::string why_no_simulation();

/// Measures the speed of one core of this machine on the largest part of the decomposition. If that
/// part is too large for a trial, a smaller part is measured.
NodeSpeed own_speed(const SimulatedProblem& what, const Decomposition& decomposition);
/// Speed of a node with a given number of element-steps per second [1/s], for every schedule.
NodeSpeed given_speed(const std::string& name, double element_steps_per_s, const Method& method);

/// Plans what each strategy computes and exchanges. Strategies through shared memory are left out,
/// because every rank is a node of its own.
/// @param speeds  of each part's node, or one of all
/// @param halo  strategy to run, or "auto"
/// @param threads  threads of each node: some strategies are not possible with several
SimulationPlan make_plan(const SimulatedProblem& what, const Decomposition& decomposition,
                         std::span<const NodeSpeed> speeds, const std::string& halo, int steps,
                         int threads = 1);

/// Time of a step [s] if nobody waits and nothing is exchanged.
/// @param speeds  of all nodes
double ideal_step_s(const SimulatedProblem& what, std::span<const NodeSpeed> speeds);

/// Name of the platform that describes this machine, with message costs measured by ping-pong
/// between two ranks.
inline constexpr const char* host_platform = "this_host";

/// A platform file: a name in experiments/platforms, a path, or made for this host.
class Platform {
public:
  /// @throws InputError with the nearest known name; for this host, if ranks cannot run here
  explicit Platform(const std::string& name_or_path);
  /// Checks that a name is known, without measuring. @throws InputError as above
  static void require_known(const std::string& name_or_path);
  /// Names of all shipped platforms, and this host.
  static std::vector<std::string> names();
  const std::string& path() const { return path_; }

private:
  std::string path_;
  std::shared_ptr<const void> temporary_; ///< removes the file if it was made here
};

/// Runs a plan on a platform. @throws InputError with SimGrid's message if it fails
SimulatedRun simulate(const SimulationPlan& plan, const std::string& platform);

} // namespace dss
