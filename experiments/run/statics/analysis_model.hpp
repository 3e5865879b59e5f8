#pragma once
/// Chooses the model of an analysis.
#include "experiments/run/timed/run.hpp"

#include <string>

namespace dss {

/// The model and the reason.
struct AnalysisModel {
  Model model;
  std::string why;      ///< one line
  bool is_auto = false; ///< nobody named the model
};

/// Model of statics: --model, or the scene's. Without either, or with "auto": the smallest model
/// whose equilibrium is proven to be one of the spatial model; for a linear solver, the smallest
/// linear model with the degrees of freedom.
/// @throws InputError for a model that the problem does not stay in, or that the solver cannot
/// solve
AnalysisModel static_model(const RunRequest& run, const Scene& scene, const std::string& solver);

/// The linear model of least work that has the degrees of freedom.
Model smallest_linear(const Problem& problem);

/// Gives factors so many threads. The library that makes them is loaded now only if there are
/// several.
/// @throws InputError for a number that makes no sense, or if the library is missing
void use_threads_for_factors(int threads);

/// Model of natural modes: --model, or the scene's; "auto" means the spatial model.
/// @throws InputError as static_model
Model modal_model(const RunRequest& run, const Scene& scene);

} // namespace dss
