/// Options of analyses, and the options of `run` that each analysis accepts.
#include "experiments/run/plan/names.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

/// Options of `run` that the analysis uses, other than SCENE, --analysis and --set.
std::vector<std::string> options_of(const std::string& analysis, const std::string& solver) {
  if (analysis == "modal")
    return {"--modes", "--prestressed", "--threads", "--model", "--output", "--json"};
  std::vector<std::string> known = {"--solver",  "--model", "--output",  "--state",
                                    "--picture", "--probe", "--history", "--json"};
  if (solver != "cg") known.emplace_back("--threads");
  if (solver == "relaxation")
    for (const char* more : {"--masses", "--tolerance", "--variant", "--device", "--hybrid",
                             "--precision", "--integrator", "--steps"})
      known.emplace_back(more);
  if (solver == "cg" || solver == "newton" || solver == "auto")
    known.emplace_back("--preconditioner");
  return known;
}

void require_known(const char* what, const std::string& name,
                   const std::vector<std::string>& known) {
  if (std::ranges::find(known, name) == known.end())
    throw InputError(
        fmt::format("--{} {}: unknown {}; {}", what, name, what, nearest_name(name, known)));
}

} // namespace

void add_analysis_options(CLI::App& command, AnalysisRequest& request) {
  const auto add = [&](const char* option, auto& value, const char* help) {
    return command.add_option(option, value, help)->group("Analyses");
  };
  add("--analysis", request.analysis,
      "dynamic, static (equilibrium under the loads at the end of the run), modal (natural "
      "frequencies); default: the scene's")
      ->type_name("ANALYSIS");
  add("--solver", request.solver,
      "With static: direct or cg (linear equations), newton, relaxation (explicit steps with "
      "kinetic damping, on any variant), auto")
      ->capture_default_str()
      ->type_name("SOLVER");
  add("--preconditioner", request.preconditioner,
      "With conjugate gradients: incomplete_cholesky or block_jacobi")
      ->capture_default_str()
      ->type_name("PRECONDITIONER");
  add("--tolerance", request.tolerance,
      "With relaxation: largest unbalanced forces, relative to the loads")
      ->capture_default_str();
  add("--masses", request.masses,
      "With relaxation: scaled (all degrees of freedom become equally fast) or scene")
      ->capture_default_str()
      ->type_name("MASSES");
  add("--modes", request.modes, "With modal: number of modes with a nonzero frequency")
      ->capture_default_str();
  command
      .add_flag("--prestressed", request.is_prestressed,
                "With modal: modes about the equilibrium under the loads instead of about rest")
      ->group("Analyses");
}

std::string chosen_analysis(const CLI::App& command, const RunRequest& run,
                            const AnalysisRequest& request) {
  const std::string analysis =
      request.analysis ? *request.analysis : scene_analysis(run.scene, run.overrides);
  require_known("analysis", analysis, names_of("ANALYSIS"));
  require_known("solver", request.solver, names_of("SOLVER"));
  const bool is_dynamic = analysis == "dynamic";
  const std::vector<std::string> own = options_of(analysis, request.solver);
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string name = "--" + option->get_lnames().front();
    if (name == "--analysis" || name == "--set") continue;
    const bool is_foreign =
        is_dynamic ? option->get_group() == "Analyses" : std::ranges::find(own, name) == own.end();
    if (!is_foreign) continue;
    const std::string what =
        analysis == "static" ? fmt::format("static --solver {}", request.solver) : analysis;
    throw InputError(is_dynamic ? fmt::format("{}: only with --analysis static or modal", name)
                                : fmt::format("{}: has no part in --analysis {}, which takes {}",
                                              name, what, fmt::join(own, ", ")));
  }
  return analysis;
}

} // namespace dss
