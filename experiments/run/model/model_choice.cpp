#include "experiments/run/model/model_choice.hpp"
#include "experiments/run/model/relative_error.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// Reason why a model of small rotations is no candidate; empty if it is one.
std::string why_not_bounded(const Problem& problem, Model model, double tolerance,
                            const std::string& no_watch) {
  if (std::string reason = why_not(model, problem); !reason.empty()) return reason;
  if (!has_rotation_vectors(model)) return why_not_exact(model, problem);
  if (tolerance < least_bounded_tolerance)
    return fmt::format("small rotations are assumed, and a tolerance of {:g} is below {:g}, where "
                       "only proof helps",
                       tolerance, least_bounded_tolerance);
  if (!no_watch.empty())
    return fmt::format("small rotations are assumed, and this run cannot be watched: {}", no_watch);
  if (const double error = error_at_start(problem, model); !(error <= bounded_share * tolerance))
    return fmt::format("small rotations are assumed, and at the start their error may be {:.3g}, "
                       "above {:g} of the "
                       "tolerance {:g}",
                       error, bounded_share, tolerance);
  return {};
}

} // namespace

std::string why_no_watch(const Method& method) {
  if (method.is_exponential) return "its method is for linear models alone";
  return method.is_implicit() ? "its method is implicit" : "";
}

std::string why_exact(Model model) {
  if (has_rotation_vectors(model))
    return "proven: all elements move alike, so no link is strained and nothing turns";
  if (degrees_of(model) == dof_ux)
    return "proven: everything acts along x, on single rows or on rows that move alike, so nothing "
           "turns or shears";
  if (is_of_plane(model))
    return "proven: one element thick, and loads, clamps and start are symmetric about the plane";
  return "six degrees of freedom and finite rotations: no smaller model is known to suffice";
}

double error_at_start(const Problem& problem, Model model) {
  const std::vector<double> state = initial_state(problem);
  ModelErrorBound bound(problem, model);
  bound.look(state, 0);
  return relative_error(problem, bound.errors(), largest_of_kinds(state));
}

ModelChoice choose_model(const Problem& problem, double tolerance, const std::string& no_watch) {
  ModelChoice choice{"auto", Model::spatial, "", {}, tolerance, false};
  const Model exact = smallest_exact(problem);
  for (const Model model : models) {
    choice.chosen = model;
    if (model == exact) break;
    // A watched model must save more time than watching costs. No model below a proven one does.
    std::string reason = exact != Model::spatial
                             ? why_not_exact(model, problem)
                             : why_not_bounded(problem, model, tolerance, no_watch);
    if (reason.empty()) {
      choice.is_bounded = true;
      break;
    }
    choice.smaller.emplace_back(model, std::move(reason));
  }
  choice.why = choice.is_bounded ? fmt::format("it has the degrees of freedom, and a bound of the "
                                               "error of small rotations is watched "
                                               "against the tolerance {:g}",
                                               tolerance)
                                 : why_exact(choice.chosen);
  return choice;
}

} // namespace dss
