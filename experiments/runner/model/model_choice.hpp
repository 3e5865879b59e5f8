#pragma once
/// `--model auto`: the smallest model whose sufficiency follows from the scene, by proof, or by a bound that is watched while the run goes.
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <string>
#include <utility>
#include <vector>

namespace dss {

/// Below this tolerance of a model's error only proof helps: rotations would have to stay below as many radians.
constexpr double least_bounded_tolerance = 1e-7;
/// Of the tolerance that the bound of a model's error may take; the rest is left to what comes after a promotion, and to rounding.
constexpr double bounded_share = 0.5;

struct ModelChoice {
  std::string asked = "spatial";                      ///< "auto", or a model's name
  Model chosen = Model::spatial;                      ///< at the start
  std::string why;                                    ///< one line
  std::vector<std::pair<Model, std::string>> smaller; ///< why not each model of less work
  double tolerance = 0;                               ///< of the model's error, relative as state_error
  bool is_bounded = false;                            ///< no proof: the error is watched
};

/// @param tolerance     of the model's error: relative, as state_error
/// @param no_watch      empty, or why this run cannot be watched, so that it takes what is proven: "steps are adaptive"
ModelChoice choose_model(const Problem& problem, double tolerance, const std::string& no_watch = {});

/// Empty, or why runs of the method cannot be watched.
std::string why_no_watch(const Method& method);

/// Why the problem has a proof for the model, one line; `why_not_exact` must be empty.
std::string why_exact(Model model);

/// Relative bound of a model's error at the start of the problem, as state_error; 0 where nothing has turned yet.
double error_at_start(const Problem& problem, Model model);

} // namespace dss
