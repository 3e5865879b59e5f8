#include "experiments/run/statics/analysis_model.hpp"
#include "experiments/run/model/model_choice.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"
#include "solver/statics/factors.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

Model known_model(const std::string& text) {
  if (const std::optional<Model> model = find_model(text)) return *model;
  throw InputError(fmt::format("--model {}: unknown model; {}", text,
                               nearest_name(text, model_names_and_auto())));
}

/// Requires that the model has the degrees of freedom of all loads and clamps. The initial state
/// does not matter in statics.
void require_sufficient(Model model, const Problem& problem) {
  if (const std::string why = why_no_degrees(model, problem); !why.empty())
    throw InputError(fmt::format("--model {}: {}: {}; use --model {}", name(model), problem.name,
                                 why, is_linear(model) ? "linear" : "spatial"));
}

/// Proofs for smaller linear models exist, but linear equations cannot tell a stable equilibrium
/// from an unstable one.
AnalysisModel smallest_model(const Problem& problem) {
  const std::string reason = why_not_exact(Model::planar, problem);
  if (reason.empty()) return {Model::planar, why_exact(Model::planar), true};
  return {Model::spatial, fmt::format("nothing proves that all stays in a plane: {}", reason),
          true};
}

} // namespace

/// This always finds one: `linear` is in `models` and has the degrees of freedom of every problem.
Model smallest_linear(const Problem& problem) {
  return *std::ranges::find_if(models, [&](Model model) {
    return is_linear(model) && why_no_degrees(model, problem).empty();
  });
}

void use_threads_for_factors(int threads) {
  if (threads < 1 || threads > 1024)
    throw InputError(fmt::format("--threads {}: give 1 to 1024", threads));
  if (threads > 1) set_factor_threads(threads);
}

AnalysisModel static_model(const RunRequest& run, const Scene& scene, const std::string& solver) {
  const bool wants_linear = solver == "direct" || solver == "cg";
  const std::string text = run.model.value_or(scene.asked_model);
  const bool is_of_scene = !run.model && text != "auto";
  // A linear solver implies a linear model, even if the scene names another for its runs.
  if (wants_linear && (text == "auto" || (is_of_scene && !is_linear(known_model(text)))))
    return {
        smallest_linear(scene.problem),
        fmt::format("the smallest linear model that has the degrees of freedom; {} solves no other",
                    solver),
        true};
  if (text == "auto") return smallest_model(scene.problem);
  const Model model = known_model(text);
  if (wants_linear && !is_linear(model))
    throw InputError(fmt::format(
        "--solver {}: solves linear equations; give --model linear, or --solver newton", solver));
  if (solver == "newton" && is_linear(model))
    throw InputError(fmt::format(
        "--solver newton: equations of the model {} are linear; give --solver direct or cg", text));
  require_sufficient(model, scene.problem);
  return {model, is_of_scene ? "named by the scene" : "asked for"};
}

Model modal_model(const RunRequest& run, const Scene& scene) {
  const std::string text = run.model.value_or(scene.asked_model);
  if (text == "auto") return Model::spatial;
  const Model model = known_model(text);
  require_sufficient(model, scene.problem);
  return model;
}

} // namespace dss
