/// Prints the result of an analysis and writes its files.
#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_summary.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "experiments/run/timed/history.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/run_record.hpp"
#include "solver/io/atomic_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>

namespace dss {
namespace {

using Json = nlohmann::ordered_json;

/// Largest displacement of a mode in a picture, relative to the largest extent of the bodies.
constexpr double shown_displacement = 0.1;

double hertz(const NaturalMode& mode) { return mode.omega / (2 * M_PI); }

Json modes_json(const ModalAnalysis& modal) {
  Json modes = Json::array();
  for (const NaturalMode& mode : modal.modes)
    modes.push_back({{"frequency_hz", hertz(mode)},
                     {"omega_rad_s", mode.omega},
                     {"effective_mass_kg", mode.effective_mass},
                     {"element", mode.element},
                     {"element_energy_share", mode.element_share}});
  return modes;
}

void print_modes(const AnalysisResult& result) {
  std::vector<std::vector<std::string>> rows;
  for (const NaturalMode& mode : result.modal.modes) {
    std::vector<std::string> row = {fmt::format("{}", rows.size() + 1),
                                    fmt::format("{:.8g}", hertz(mode))};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double all = result.modal.free_mass[axis];
      row.push_back(fmt::format("{:.2f}", all > 0 ? 100 * mode.effective_mass[axis] / all : 0));
    }
    row.push_back(fmt::format("{}", mode.element));
    row.push_back(fmt::format("{:.2f}", 100 * mode.element_share));
    rows.push_back(std::move(row));
  }
  fmt::print("{}", text_table({"mode", "frequency [Hz]", "mass x [%]", "mass y [%]", "mass z [%]",
                               "element", "its energy [%]"},
                              rows));
  if (result.modal.free_motions > 0)
    fmt::print("{} motions without stiffness (rigid motions, mechanisms) besides\n",
               result.modal.free_motions);
}

void print_static(const AnalysisResult& result) {
  if (result.solver == "relaxation")
    fmt::print(
        "relaxation by {} ({}), {}, {}: {} steps of {:.6g} s, {} peaks of the kinetic energy\n",
        result.variant, result.isa, result.precision, result.integrator, result.steps, result.dt_s,
        result.iterations);
  else
    fmt::print("{}{}: {} corrections, {} matrices{}\n", result.solver,
               result.solver == "newton" ? fmt::format(" ({})", result.linear_solver) : "",
               result.iterations, result.matrices,
               result.cg_iterations > 0
                   ? fmt::format(", {} iterations of conjugate gradients", result.cg_iterations)
                   : "");
  fmt::print("unbalanced forces {:.3g} of the loads, largest displacement {:.9g} m, elastic energy "
             "{:.6g} J\n",
             result.residual, result.max_displacement_m, result.energy_j);
  if (result.reactions) fmt::print("{}\n", reactions_text(*result.reactions));
}

/// Largest extent of all bodies [m].
double extent(const Problem& problem) {
  Eigen::Array3d low = Eigen::Array3d::Constant(INFINITY), high = -low;
  problem.lattice.for_each_element([&](std::size_t, const Row& row, int x) {
    const Vec3 place = rest_position(problem, row, x),
               &edge = problem.bodies[std::size_t(row.body)].edge;
    const Eigen::Array3d centre(place[0], place[1], place[2]),
        half = Eigen::Array3d(edge[0], edge[1], edge[2]) / 2;
    low = low.min(centre - half);
    high = high.max(centre + half);
  });
  return (high - low).maxCoeff();
}

/// Writes each mode as a displaced state. Its size is `shown_displacement` of the body. A rotation
/// counts by the motion of an element's edge.
void write_shapes(const Problem& problem, const RunRequest& run, FileSet& outputs,
                  AnalysisResult& result) {
  StaticSystem system(problem, Rotation::linearised, degrees_of(*find_model(result.model)));
  const double size = shown_displacement * extent(problem), edge = shortest_edge(problem);
  FrameSeries series(run.output, true, outputs);
  for (std::size_t n = 0; n < result.modal.modes.size(); ++n) {
    const Eigen::VectorXd& shape = result.modal.modes[n].shape;
    double largest = 0;
    for (Eigen::Index k = 0; k < shape.size(); ++k)
      largest = std::max(largest, std::abs(shape[k]) *
                                      (system.dofs().dof[std::size_t(k)] % 6 < 3 ? 1 : edge / 2));
    StaticSystem::State state = system.rest();
    system.move(state, size / largest * shape);
    series.add(problem, system.fields(state), Rotation::linearised, {}, double(n + 1));
  }
  result.files.push_back(series.finish());
}

void write_files(const RunRequest& run, FileSet& outputs, AnalysisResult& result) {
  if (run.output.empty() && final_files(run).empty() && run.history.empty()) return;
  const Problem problem = load_scene(run.scene, run.overrides).problem;
  if (result.analysis == "modal") return write_shapes(problem, run, outputs, result);
  const Rotation equations = rotation_of(*find_model(result.model));
  FrameSeries frame(run.output, false, outputs);
  frame.add(problem, result.state, equations, result.signals, 0);
  if (const std::string written = frame.finish(); !written.empty()) result.files.push_back(written);
  if (!run.history.empty()) {
    RunHistory history(run.history, problem, read_probes(run.probes, problem));
    history.add(0, 0, result.state, equations, result.signals);
    history.write(outputs);
    result.probes = history.probe_texts();
    result.files.push_back(run.history);
  }
  write_final_files(outputs, run, problem, result.state, equations, result.signals);
  for (const std::string& file : final_files(run)) result.files.push_back(file);
}

} // namespace

Json analysis_json(const RunRequest& run, const AnalysisResult& result) {
  Json json = record_of(result.scene, run.overrides);
  json["analysis"] = result.analysis;
  json["model"] = result.model;
  json["elements"] = result.elements;
  json["links"] = result.links;
  json["unknowns"] = result.unknowns;
  json["wall_s"] = result.wall_s;
  if (result.analysis == "modal") {
    json["modes"] = modes_json(result.modal);
    json["free_motions"] = result.modal.free_motions;
    json["free_mass_kg"] = result.modal.free_mass;
  } else {
    const bool is_stepped = result.solver == "relaxation";
    const auto if_stepped = [&](const auto& value) { return is_stepped ? Json(value) : Json(); };
    json["model_why"] = result.model_why;
    json["solver"] = result.solver;
    json["linear_solver"] = is_stepped ? Json() : Json(result.linear_solver);
    json["iterations"] = result.iterations;
    json["matrices"] = is_stepped ? Json() : Json(result.matrices);
    json["cg_iterations"] = is_stepped ? Json() : Json(result.cg_iterations);
    json["variant"] = if_stepped(result.variant);
    json["isa"] = if_stepped(result.isa);
    json["precision"] = if_stepped(result.precision);
    json["integrator"] = if_stepped(result.integrator);
    json["threads"] = if_stepped(result.threads);
    json["steps"] = if_stepped(result.steps);
    json["dt_s"] = if_stepped(result.dt_s);
    json["residual"] = result.residual;
    json["max_displacement_m"] = result.max_displacement_m;
    json["energy_j"] = result.energy_j;
    json["reaction_force_n"] = result.reactions ? Json(result.reactions->force) : Json();
    json["reaction_moment_n_m"] = result.reactions ? Json(result.reactions->moment) : Json();
  }
  json["status"] = result.status;
  json["reason"] = result.reason;
  json["note"] = result.note;
  return json;
}

int run_analysis(const std::string& analysis, const RunRequest& run,
                 const AnalysisRequest& request) {
  for (const std::string& path : {run.output, run.state_csv, run.picture, run.history,
                                  run.json == "-" ? std::string() : run.json})
    if (!path.empty()) require_writable(path);
  AnalysisResult result =
      analysis == "static" ? solve_static(run, request) : solve_modal(run, request);
  const bool is_fine = result.status == "ok";
  FileSet outputs;
  if (is_fine) write_files(run, outputs, result);
  write_json(outputs, run.json, analysis_json(run, result));
  if (run.json != "-") {
    fmt::print("{}: {} analysis, {} elements, {} links, {} unknowns ({}), {:.4g} s\n", result.scene,
               result.analysis, result.elements, result.links, result.unknowns, result.model,
               result.wall_s);
    if (analysis == "static")
      print_static(result);
    else
      print_modes(result);
    if (!result.note.empty()) fmt::print("note: {}\n", result.note);
    for (const std::string& probe : result.probes) fmt::print("{}\n", probe);
    for (const std::string& file : result.files) fmt::print("wrote {}\n", file);
  }
  if (is_fine) return exit_success;
  fmt::print(stderr, "dssbench: {}: {}\n", result.scene, result.reason);
  return exit_check_failed;
}

} // namespace dss
