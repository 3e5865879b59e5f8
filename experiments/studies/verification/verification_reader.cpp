#include "experiments/measure/study_names.hpp"
#include "experiments/studies/verification/verification_study.hpp"

#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

void read_grids(const Node& node, double most, VerificationProblem& problem) {
  ObjectNode object(node);
  problem.refined = object.require("parameter").name();
  const Node values = object.require("values");
  object.finish();
  for (const Node& item : values.items(3)) {
    const double value = item.positive();
    if (!problem.values.empty() && value <= problem.values.back())
      item.fail(
          fmt::format("{:g} does not refine {:g}; values ascend", value, problem.values.back()));
    if (value <= most || problem.values.size() < 3) problem.values.push_back(value);
  }
}

VerifiedFigure read_figure(const Node& node, const VerificationProblem& problem) {
  ObjectNode object(node);
  VerifiedFigure figure;
  figure.name = object.require("figure").name();
  figure.unit = object.require("unit").text();
  if (problem.analysis == "modal") {
    figure.mode = object.require("mode").count(1);
  } else {
    figure.column = object.require("column").name();
    if (const auto minus = object.find("minus")) figure.minus = minus->name();
    if (problem.analysis == "dynamic") figure.is_peak = object.flag_or("peak", false);
  }
  figure.scale = Formula(object, "scale");
  const auto reference = object.find("reference");
  figure.reference = reference ? reference->number() : std::numeric_limits<double>::quiet_NaN();
  if (figure.reference == 0) reference->fail("errors are relative; take a figure that is not 0");
  figure.uncertainty = object.non_negative_or("uncertainty", 0);
  if (const auto differs = object.find("differs")) figure.differs = differs->name();
  object.finish();
  return figure;
}

VerificationProblem read_problem(const Node& node, const std::string& path, double most) {
  ObjectNode object(node);
  VerificationProblem problem;
  problem.name = object.require("problem").name();
  problem.title = object.require("title").text();
  problem.source = object.require("source").text();
  problem.scene = scene_beside(path, object.require("scene").name());
  problem.analysis =
      object.require("analysis").known_name("analysis", {"static", "modal", "dynamic"});
  if (const auto model = object.find("model"))
    problem.model = model->known_name("model", model_names());
  problem.set = one_set(object, "set");
  problem.probes = object.names_or("probes", {});
  read_grids(object.require("refine"), most, problem);
  for (const Node& item : object.require("figures").items(1))
    problem.figures.push_back(read_figure(item, problem));
  problem.tolerance = object.require("tolerance").positive();
  object.finish();
  return problem;
}

} // namespace

VerificationStudy read_verification(const StudyFile& file) {
  ObjectNode scale(file.scale);
  const double most = scale.positive_or("up_to", 1e9);
  scale.finish();
  VerificationStudy study{file.name, file.title, file.path, {}};
  for (const Node& item : file.part("verification").items(1))
    study.problems.push_back(read_problem(item, file.path, most));
  return study;
}

} // namespace dss
