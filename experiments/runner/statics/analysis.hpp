#pragma once
/// Analyses besides the run in time: states of rest, natural modes. The body of `dssbench run --analysis ...`.
#include "experiments/runner/run.hpp"
#include "solver/statics/equilibrium.hpp"
#include "solver/statics/modal.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dss {

struct AnalysisRequest {
  std::optional<std::string> analysis;                ///< dynamic, static, modal; absent: the scene's
  std::string solver = "auto";                        ///< of statics: direct, cg, newton, relaxation, auto
  std::string preconditioner = "incomplete_cholesky"; ///< of cg; or block_jacobi
  std::string masses = "scaled";                      ///< of relaxation; or scene
  double tolerance = 1e-10;                           ///< of relaxation: unbalanced forces against the loads
  int modes = 6;
  bool is_prestressed = false; ///< modes about the equilibrium under the loads instead of about rest
  double loads = 1;            ///< of studies: loads are multiplied by it
};

struct AnalysisResult {
  std::string analysis, scene, model;
  std::string model_why;                           ///< of statics: who chose it, or why it is enough
  std::string solver;                              ///< direct, cg, newton, relaxation
  std::string linear_solver;                       ///< of direct, cg and newton
  std::string variant, isa, precision, integrator; ///< of relaxation
  int threads = 1;
  std::size_t elements = 0, links = 0;
  long unknowns = 0;
  long iterations = 0;                  ///< corrections of the state; peaks of the kinetic energy
  long matrices = 0, cg_iterations = 0; ///< of direct, cg and newton
  long steps = 0;                       ///< of relaxation
  double dt_s = 0;                      ///< likewise
  double residual = 0;                  ///< unbalanced forces against the loads, as the oracle finds them in the state
  double wall_s = 0;
  double max_displacement_m = 0;
  double energy_j = 0; ///< elastic
  ModalAnalysis modal;
  std::vector<double> state;         ///< of statics, 13 numbers an element
  std::vector<std::string> files;    ///< written, in words
  std::string status = "ok", reason; ///< "not converged": how far it came
  std::string note;                  ///< what a user should know of a result that is fine
};

/// Adds the options of analyses to those of `run`.
void add_analysis_options(CLI::App& command, AnalysisRequest& request);

/// The analysis that a user asks for, or the scene does; "dynamic" is an ordinary run.
/// @throws InputError for an unknown one, or for options of `command` that were given and have no part in it
std::string chosen_analysis(const CLI::App& command, const RunRequest& run, const AnalysisRequest& request);

/// A state of rest under the loads as they are at the end of the scene's run.
/// @throws InputError, UnstableError as find_equilibrium, and for anything wrong with the request
AnalysisResult solve_static(const RunRequest& run, const AnalysisRequest& request);
AnalysisResult solve_modal(const RunRequest& run, const AnalysisRequest& request);

/// Solves, writes what is asked for, prints. @return exit code
int run_analysis(const std::string& analysis, const RunRequest& run, const AnalysisRequest& request);

nlohmann::ordered_json analysis_json(const RunRequest& run, const AnalysisResult& result);

} // namespace dss
