#pragma once
/// Turns a request into a plan. All mistakes in the request are found here, before anything is
/// computed.
#include "experiments/run/model/model_choice.hpp"
#include "experiments/run/plan/lack.hpp"
#include "experiments/run/plan/probe.hpp"
#include "experiments/run/plan/run_request.hpp"
#include "experiments/run/state/oracle_state.hpp"
#include "experiments/run/state/solution.hpp"
#include "variants/loading/loader.hpp"

#include <memory>
#include <optional>

namespace dss {

/// A run in which every value is decided.
struct RunPlan {
  Scene scene;
  const Plugin* plugin = nullptr;
  Distribution distribution;            ///< used by distributed variants
  std::shared_ptr<const Method> fitted; ///< method fitted to the problem and its step
  const Method* method = nullptr;       ///< fitted.get(); with adaptive steps dopri5_adaptive()
  Model model = Model::spatial;         ///< model at the start
  ModelChoice model_choice;
  Precision precision = Precision::f64;
  Rotation rotation = Rotation::quaternion;
  double dt = 0;  ///< step [s]; with adaptive steps the first step
  long steps = 0; ///< with adaptive steps: the run ends at the time steps x dt
  std::optional<StepTolerance> adaptive;
  long tail_steps = 0; ///< number of last steps of a longer run that are checked against the oracle
  double stability_limit = 0;
  std::optional<OracleState> expected; ///< expected state at step expected->steps
  std::optional<Solution> reference;   ///< solution that errors are measured against
  long steps_between = 0;              ///< steps between saved times of the reference
  /// steps at which a frame is written: ascending, the last is `steps`
  std::vector<long> frame_steps;
  std::vector<Probe> probes;
  std::vector<long> history_steps; ///< steps of the rows of the history: likewise

  const Tolerance& tolerance() const {
    return precision == Precision::f64 ? scene.problem.tolerance_f64 : scene.problem.tolerance_f32;
  }
};

/// Makes the plan of a request. @throws InputError, UnstableError as run_scene
RunPlan plan_run(const RunRequest& request);

/// Requires that the files of a request can be written. @throws InputError
void require_outputs_writable(const RunRequest& request);

/// Finds a precision by name. @throws InputError with the nearest known name
Precision require_precision_name(const std::string& name);

/// Requires a positive tolerance and returns it. @throws InputError
double require_model_tolerance(double tolerance);

/// Finds a method by name. @throws InputError with the nearest known name
const Method& require_method(const std::string& name);

/// Requires a step that is not above the stability limit.
/// @param known  the limit [s] if it is already known; else it is predicted
/// @return the limit [s]
/// @throws UnstableError if dt is above the limit and not forced; the message has both numbers
double require_stable(const Problem& problem, const Method& method, double dt, bool is_forced,
                      std::optional<double> known = {});

} // namespace dss
