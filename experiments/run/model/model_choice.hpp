#pragma once
/// `--model auto`: finds the smallest model that is sufficient for a scene. Sufficiency follows
/// from a proof, or from an error bound that is watched during the run.
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <string>
#include <utility>
#include <vector>

namespace dss {

/// For smaller tolerances of a model's error, only proven models qualify: rotations would have to
/// stay below the same number of radians.
constexpr double least_bounded_tolerance = 1e-7;
/// Share of the tolerance that the bound of a model's error may use. The rest is for rounding and
/// for the errors after a promotion (a change to a larger model).
constexpr double bounded_share = 0.5;

/// The chosen model and the reasons.
struct ModelChoice {
  std::string asked = "spatial";                      ///< "auto", or the name of a model
  Model chosen = Model::spatial;                      ///< model at the start
  std::string why;                                    ///< one line
  std::vector<std::pair<Model, std::string>> smaller; ///< reason against each model of less work
  double tolerance = 0;    ///< of the model's error, relative as in state_error
  bool is_bounded = false; ///< not proven: the error is watched
};

/// Chooses the model of a run.
/// @param tolerance  of the model's error, relative as in state_error
/// @param no_watch  reason why this run cannot be watched, "steps are adaptive"; only proven models
/// then qualify. Empty if it can be watched.
ModelChoice choose_model(const Problem& problem, double tolerance,
                         const std::string& no_watch = {});

/// Reason why runs of the method cannot be watched; empty if they can. Promotions of implicit
/// methods are not built.
std::string why_no_watch(const Method& method);

/// One line that says why the model is proven exact for the problem. Requires that `why_not_exact`
/// is empty.
std::string why_exact(Model model);

/// Relative bound of a model's error at the start of the problem, as in state_error; 0 if nothing
/// is rotated yet.
double error_at_start(const Problem& problem, Model model);

} // namespace dss
