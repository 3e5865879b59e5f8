#pragma once
/// Which model an analysis solves.
#include "experiments/runner/run.hpp"

#include <string>

namespace dss {

struct AnalysisModel {
  Model model;
  std::string why;      ///< one line
  bool is_auto = false; ///< nobody named it
};

/// Of statics: --model, or the scene's; without either, or with "auto", the smallest whose equilibrium is proven to be one of the spatial model, of linear
/// solvers the smallest linear one that has the degrees of freedom. @throws InputError for a model that the problem leaves, or the solver cannot solve
AnalysisModel static_model(const RunRequest& run, const Scene& scene, const std::string& solver);

/// The linear model of least work that has the degrees of freedom.
Model smallest_linear(const Problem& problem);

/// Of natural modes: --model, or the scene's; "auto" is all six degrees of freedom. @throws InputError likewise
Model modal_model(const RunRequest& run, const Scene& scene);

} // namespace dss
