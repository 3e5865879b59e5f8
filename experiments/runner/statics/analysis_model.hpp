#pragma once
/// Which model an analysis solves.
#include "experiments/runner/run.hpp"

namespace dss {

/// Of statics: --model, or linear for the solvers direct and cg, or the scene's. "auto": the smallest whose results are proven to be those of the
/// solver's largest. @throws InputError for a model that the problem leaves, or the solver cannot solve
Model static_model(const RunRequest& run, const Scene& scene, const std::string& solver);

/// Of natural modes: --model, or the scene's; "auto" is all six degrees of freedom. @throws InputError likewise
Model modal_model(const RunRequest& run, const Scene& scene);

} // namespace dss
