#include "experiments/runner/statics/analysis_model.hpp"
#include "experiments/runner/model/model_choice.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

Model known_model(const std::string& text) {
  if (const std::optional<Model> model = find_model(text)) return *model;
  throw InputError(fmt::format("--model {}: unknown model; {}", text, nearest_name(text, model_names_and_auto())));
}

/// All of them have loads and clamps of the problem; which start they could not take does not matter to statics.
void require_sufficient(Model model, const Problem& problem) {
  if (const std::string why = why_not(model, problem); !why.empty())
    throw InputError(fmt::format("--model {}: {}: {}; use --model {}", name(model), problem.name, why,
                                 is_linear(model) ? "linear" : "spatial"));
}

/// Smaller linear models have proofs too, but their equations do not tell a stable equilibrium from another.
AnalysisModel smallest_model(const Problem& problem) {
  const std::string reason = why_not_exact(Model::planar, problem);
  if (reason.empty()) return {Model::planar, why_exact(Model::planar), true};
  return {Model::spatial, fmt::format("nothing proves that all stays in a plane: {}", reason), true};
}

} // namespace

/// `linear` is one of `models`, and every problem has the degrees of freedom for it.
Model smallest_linear(const Problem& problem) {
  return *std::ranges::find_if(models,
                               [&](Model model) { return is_linear(model) && why_not(model, problem).empty(); });
}

AnalysisModel static_model(const RunRequest& run, const Scene& scene, const std::string& solver) {
  const bool wants_linear = solver == "direct" || solver == "cg";
  const std::string text = run.model.value_or(scene.asked_model);
  const bool is_of_scene = !run.model && text != "auto";
  // Who asks for a linear solver wants another model than that of the scene's runs.
  if (wants_linear && (text == "auto" || (is_of_scene && !is_linear(known_model(text)))))
    return {smallest_linear(scene.problem),
            fmt::format("the smallest linear model that has the degrees of freedom; {} solves no other", solver), true};
  if (text == "auto") return smallest_model(scene.problem);
  const Model model = known_model(text);
  if (wants_linear && !is_linear(model))
    throw InputError(
        fmt::format("--solver {}: solves linear equations; give --model linear, or --solver newton", solver));
  if (solver == "newton" && is_linear(model))
    throw InputError(
        fmt::format("--solver newton: equations of the model {} are linear; give --solver direct or cg", text));
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
