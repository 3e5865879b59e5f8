#pragma once
/// A request made definite: everything that can be wrong with it is found before anything is computed.
#include "experiments/runner/oracle_state.hpp"
#include "experiments/runner/precision/solution.hpp"
#include "experiments/runner/run.hpp"
#include "variants/loader.hpp"

#include <memory>
#include <optional>

namespace dss {

struct RunPlan {
  Scene scene;
  const Plugin* plugin = nullptr;
  Distribution distribution;            ///< of a distributed variant
  std::shared_ptr<const Method> fitted; ///< to the problem and its step
  const Method* method = nullptr;       ///< fitted.get(), or of adaptive steps dopri5_adaptive()
  Model model = Model::spatial;         ///< at the start
  ModelChoice model_choice;
  Precision precision = Precision::f64;
  Rotation rotation = Rotation::quaternion;
  double dt = 0;  ///< of adaptive steps the first that is tried
  long steps = 0; ///< adaptive ones end where so many of dt would
  std::optional<StepTolerance> adaptive;
  long tail_steps = 0; ///< over which the end of a longer run is compared with the oracle
  double stability_limit = 0;
  std::optional<OracleState> expected; ///< at step expected->steps
  std::optional<Solution> reference;   ///< that errors are measured against
  long steps_between = 0;              ///< saved times of the reference
  std::vector<long> frame_steps;       ///< ascending, the last is `steps`

  const Tolerance& tolerance() const {
    return precision == Precision::f64 ? scene.problem.tolerance_f64 : scene.problem.tolerance_f32;
  }
};

/// @throws InputError, UnstableError as run_scene
RunPlan plan_run(const RunRequest& request);

/// What a variant lacks for a run.
struct Lack {
  std::string option; ///< that asks for it: "--rotation tait_bryan"
  std::string what;   ///< "has quaternions alone"
};
std::optional<Lack> what_lacks(const Plugin& plugin, Precision precision, const Method& method, Rotation rotation);

/// @throws InputError for an unknown name, with the nearest
Precision require_precision_name(const std::string& name);

/// @return the tolerance. @throws InputError for one that is not positive
double require_model_tolerance(double tolerance);

/// Method by its name. @throws InputError for an unknown one, naming the nearest
const Method& require_method(const std::string& name);

/// @param known  the limit [s], if it need not be predicted
/// @throws UnstableError if dt exceeds the predicted limit; both numbers are in the message. @return the limit [s]
double require_stable(const Problem& problem, const Method& method, double dt, bool is_forced,
                      std::optional<double> known = {});

} // namespace dss
