/// One grid of a problem.
#include "experiments/base/temporary_file.hpp"
#include "experiments/run/plan/probe.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "experiments/run/timed/history.hpp"
#include "experiments/run/timed/run.hpp"
#include "experiments/studies/verification/verification_study.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>

namespace dss {
namespace {

/// Columns over time.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

Columns columns_of(const HistoryRows& history) {
  Columns columns{split_csv(history.columns, "history"), {}};
  const std::size_t width = columns.names.size();
  for (std::size_t at = 0; at < history.numbers.size(); at += width)
    columns.rows.emplace_back(history.numbers.begin() + std::ptrdiff_t(at),
                              history.numbers.begin() + std::ptrdiff_t(at + width));
  return columns;
}

Columns columns_of(const Table& table) {
  Columns columns{table.columns, {}};
  for (const Record& record : table.rows) {
    std::vector<double>& row = columns.rows.emplace_back();
    for (const std::string& name : columns.names) row.push_back(number_in(record, name));
  }
  return columns;
}

double figure_in(const Columns& columns, const VerifiedFigure& figure) {
  const auto place_of = [&](const std::string& column) {
    const auto name = std::ranges::find(columns.names, column);
    if (name == columns.names.end())
      throw InputError(
          fmt::format("figure {}: the history has no column \"{}\"", figure.name, column));
    return std::size_t(name - columns.names.begin());
  };
  const std::size_t place = place_of(figure.column);
  const std::optional<std::size_t> minus =
      figure.minus.empty() ? std::nullopt : std::optional(place_of(figure.minus));
  const auto in = [&](const std::vector<double>& row) {
    return row[place] - (minus ? row[*minus] : 0);
  };
  double value = in(columns.rows.back());
  for (const std::vector<double>& row : columns.rows)
    if (figure.is_peak && std::abs(in(row)) > std::abs(value)) value = in(row);
  return value;
}

Columns at_rest(const RunRequest& request, const Problem& problem) {
  const AnalysisResult result = solve_static(request, {});
  if (result.status != "ok") throw InputError(result.reason);
  RunHistory history("", problem, read_probes(request.probes, problem));
  history.add(0, 0, result.state, rotation_of(*find_model(result.model)), result.signals);
  return columns_of(history.kept());
}

/// Runs in time, with the history in a file that goes away.
Columns over_time(RunRequest request, const Scene& scene, long steps_factor) {
  const TemporaryFile file("", ".csv");
  request.history = file.path();
  request.dt = scene.problem.dt / double(steps_factor);
  request.steps = scene.problem.steps * steps_factor;
  request.every = std::max(1L, *request.steps / 2000);
  request.has_balance = false;
  const RunResult result = run_scene(request);
  if (result.status != "ok") throw UnstableError(result.reason);
  return columns_of(read_csv(request.history));
}

double frequency(const std::vector<NaturalMode>& modes, int number) {
  if (std::size_t(number) > modes.size())
    throw InputError(fmt::format("mode {} was not found", number));
  return modes[std::size_t(number) - 1].omega / (2 * std::numbers::pi);
}

} // namespace

GridResult solve_grid(const VerificationProblem& problem, double value, long steps_factor) {
  RunRequest request;
  request.scene = problem.scene;
  request.overrides = problem.set;
  request.overrides.push_back({problem.refined, number_text(value)});
  request.probes = problem.probes;
  if (!problem.model.empty()) request.model = problem.model;
  const Scene scene = load_scene(request.scene, request.overrides);
  GridResult grid{scene.problem.lattice.element_count, {}};
  const auto add = [&](auto&& figure_of) {
    for (const VerifiedFigure& figure : problem.figures) {
      const double scale = figure.scale.is_present() ? figure.scale(scene.parameters) : 1;
      grid.figures.push_back(scale * figure_of(figure));
    }
  };
  if (problem.analysis == "modal") {
    AnalysisRequest modal;
    for (const VerifiedFigure& figure : problem.figures)
      modal.modes = std::max(modal.modes, figure.mode);
    request.probes.clear();
    const AnalysisResult result = solve_modal(request, modal);
    if (result.status != "ok") throw InputError(result.reason);
    std::vector<NaturalMode> modes = result.modal.modes;
    std::erase_if(modes, [](const NaturalMode& mode) { return mode.omega == 0; });
    add([&](const VerifiedFigure& figure) { return frequency(modes, figure.mode); });
  } else {
    const Columns columns = problem.analysis == "static" ? at_rest(request, scene.problem)
                                                         : over_time(request, scene, steps_factor);
    add([&](const VerifiedFigure& figure) { return figure_in(columns, figure); });
  }
  return grid;
}

} // namespace dss
