#include "experiments/runner/statics/analysis_model.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"

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

/// The smallest that will do; the last of `models` is spatial.
Model smallest_model(const Problem& problem, bool wants_linear) {
  for (const Model model : models) {
    const bool is_enough =
        wants_linear ? is_linear(model) && why_not(model, problem).empty() : why_not_exact(model, problem).empty();
    if (is_enough) return model;
  }
  return Model::spatial;
}

} // namespace

Model static_model(const RunRequest& run, const Scene& scene, const std::string& solver) {
  const bool wants_linear = solver == "direct" || solver == "cg";
  const std::string text = run.model.value_or(wants_linear ? "linear" : scene.model);
  if (text == "auto") {
    const Model smallest = smallest_model(scene.problem, wants_linear);
    return solver == "newton" && is_linear(smallest) ? Model::spatial : smallest;
  }
  const Model model = known_model(text);
  if (wants_linear && !is_linear(model))
    throw InputError(
        fmt::format("--solver {}: solves linear equations; give --model linear, or --solver newton", solver));
  if (solver == "newton" && is_linear(model))
    throw InputError(
        fmt::format("--solver newton: equations of the model {} are linear; give --solver direct or cg", text));
  require_sufficient(model, scene.problem);
  return model;
}

Model modal_model(const RunRequest& run, const Scene& scene) {
  const std::string text = run.model.value_or(scene.model);
  if (text == "auto") return Model::spatial;
  const Model model = known_model(text);
  require_sufficient(model, scene.problem);
  return model;
}

} // namespace dss
