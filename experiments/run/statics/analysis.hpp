#pragma once
/// Analyses other than a run in time: static equilibrium and natural modes. The body of `dssbench
/// run --analysis ...`.
#include "experiments/run/timed/run.hpp"
#include "solver/statics/equilibrium.hpp"
#include "solver/statics/modal.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Options of an analysis.
struct AnalysisRequest {
  std::optional<std::string> analysis; ///< dynamic, static, modal; absent: the scene's
  std::string solver = "auto";         ///< of statics: direct, cg, newton, relaxation, auto
  std::string preconditioner = "incomplete_cholesky"; ///< of cg; or block_jacobi
  std::string masses = "scaled";                      ///< of relaxation; or scene
  double tolerance = 1e-10; ///< of relaxation: unbalanced forces relative to the loads
  int modes = 6;
  /// true: modes about the equilibrium under the loads; false: about rest
  bool is_prestressed = false;
  double loads = 1; ///< factor on the loads, used by studies
};

/// Result of an analysis; fields that do not apply are empty or 0.
struct AnalysisResult {
  std::string analysis, scene, model;
  std::string model_why;     ///< of statics: who chose the model, or why it is sufficient
  std::string solver;        ///< direct, cg, newton, relaxation
  std::string linear_solver; ///< of direct, cg and newton
  std::string variant, isa, precision, integrator; ///< of relaxation
  int threads = 1;
  std::size_t elements = 0, links = 0;
  long unknowns = 0;
  long iterations = 0; ///< corrections of the state; with relaxation, peaks of the kinetic energy
  long matrices = 0, cg_iterations = 0; ///< of direct, cg and newton
  long steps = 0;                       ///< of relaxation
  double dt_s = 0;                      ///< of relaxation
  /// Unbalanced forces of the final state relative to the loads, computed by the oracle.
  double residual = 0;
  double wall_s = 0;
  double max_displacement_m = 0;
  double energy_j = 0;                ///< elastic
  std::optional<Reactions> reactions; ///< of statics; absent without clamps
  ModalAnalysis modal;
  std::vector<double> state;       ///< of statics: 13 numbers per element
  std::vector<double> signals;     ///< of statics: those of the loads (StaticSystem::signals)
  std::vector<std::string> files;  ///< written files, as text
  std::vector<std::string> probes; ///< of statics: what they saw, as text
  /// other status: "not converged"; the reason says how far the analysis came
  std::string status = "ok", reason;
  std::string note; ///< a remark for the user about a valid result
};

/// Adds the options of analyses to the command `run`.
void add_analysis_options(CLI::App& command, AnalysisRequest& request);

/// The analysis that the user or the scene asks for; "dynamic" is an ordinary run.
/// @param command  `run`, whose options are checked
/// @throws InputError for an unknown analysis, or for options that do not belong to it
std::string chosen_analysis(const CLI::App& command, const RunRequest& run,
                            const AnalysisRequest& request);

/// Finds the static equilibrium under the loads that act at the end of the scene's run.
/// @throws InputError, UnstableError as find_equilibrium, and for any mistake in the request
AnalysisResult solve_static(const RunRequest& run, const AnalysisRequest& request);
/// Finds natural modes. @throws InputError for any mistake in the request
AnalysisResult solve_modal(const RunRequest& run, const AnalysisRequest& request);

/// Runs an analysis, writes its files and prints its result. @return exit code
int run_analysis(const std::string& analysis, const RunRequest& run,
                 const AnalysisRequest& request);

/// The record of an analysis as JSON.
nlohmann::ordered_json analysis_json(const RunRequest& run, const AnalysisResult& result);

} // namespace dss
