#include "experiments/studies/continuum/continuum_study.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/studies/continuum/beam_theory.hpp"
#include "solver/scene/scene.hpp"
#include "solver/statics/eigenmodes.hpp"
#include "solver/statics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

const std::vector<std::string> continuum_columns = {"experiment",
                                                    "check",
                                                    "scene",
                                                    "set",
                                                    "quantity",
                                                    "mode",
                                                    "refined",
                                                    "value",
                                                    "elements",
                                                    "spacing_m",
                                                    "figure",
                                                    "theory",
                                                    "error",
                                                    "order",
                                                    "richardson_order",
                                                    "richardson_limit",
                                                    "limit_error",
                                                    "bar",
                                                    "bar_at",
                                                    "status",
                                                    "reason",
                                                    "source"};

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Equilibrium under the loads. Stability is not required: above the buckling load a column still
/// has its straight equilibrium.
StaticSystem::State equilibrium(StaticSystem& system) {
  const Equilibrium found =
      find_equilibrium(system, {.solver = SolverKind::direct, .must_be_stable = false});
  if (!found.is_found) throw InputError(fmt::format("{}: {}", system.problem().name, found.reason));
  return found.state;
}

double deflection(const ContinuumCheck& check, const Scene& scene) {
  const Problem& problem = scene.problem;
  const double element = check.element(scene.parameters);
  if (!(element >= 0 && element < double(problem.lattice.element_count)))
    throw InputError(fmt::format("check {}: element {} is not one of the scene's {}", check.name,
                                 element, problem.lattice.element_count));
  StaticSystem system(problem);
  const std::vector<double> state = system.fields(equilibrium(system));
  return state[std::size_t(element) * field_count + std::size_t(check.field)];
}

std::vector<double> frequencies(const ContinuumCheck& check, const Problem& problem) {
  const StaticSystem system(problem);
  const StaticSystem::State rest = system.rest();
  const Eigen::VectorXd values =
      lowest_modes(system.tangent(rest), system.mass(rest), check.count).values;
  std::vector<double> all;
  for (const double value : values) all.push_back(std::sqrt(value));
  return all;
}

/// Smallest eigenvalue of the scene in equilibrium under its load; `shift` is a lower bound of it.
double loaded_eigenvalue(const ContinuumCheck& check, std::vector<Override> set, double load,
                         double shift) {
  set.push_back({check.load_parameter, number_text(load)});
  const Scene scene = load_scene(check.scene, set);
  StaticSystem system(scene.problem);
  const StaticSystem::State state = equilibrium(system);
  return lowest_modes(system.tangent(state), system.mass(state), 1, shift).values[0];
}

/// Load at which the smallest eigenvalue vanishes; above it the eigenvalue is negative. The secant
/// method converges fast because the eigenvalue is nearly linear in the load.
double critical_load(const ContinuumCheck& check, const std::vector<Override>& set) {
  double a = 0.5, b = 0.9, of_a = loaded_eigenvalue(check, set, a, 0);
  const double shift = -of_a;
  double of_b = loaded_eigenvalue(check, set, b, shift);
  for (int n = 0; n < 8 && std::abs(b - a) > 1e-9; ++n) {
    const double next = b - of_b * (b - a) / (of_b - of_a);
    a = b;
    of_a = of_b;
    b = next;
    of_b = loaded_eigenvalue(check, set, b, shift);
  }
  return b;
}

std::vector<double> theory_of(const ContinuumCheck& check, const Parameters& parameters) {
  std::vector<double> figures;
  for (const Formula& formula : check.theory) figures.push_back(formula(parameters));
  if (!figures.empty()) return figures;
  figures = cantilever_frequencies({check.bending(parameters), check.shear(parameters),
                                    check.mass(parameters), check.rotary(parameters),
                                    check.length(parameters)},
                                   check.count);
  return figures;
}

/// All figures of one refinement.
struct Refinement {
  double value = 0, spacing = 0;
  std::string scene;
  std::size_t elements = 0;
  std::vector<double> figures, theory;
};

Refinement refinement(const ContinuumCheck& check, double value) {
  std::vector<Override> set = check.set;
  set.push_back({check.refined, number_text(value)});
  const Scene scene = load_scene(check.scene, set);
  Refinement found{value,      check.spacing(scene.parameters),
                   scene.name, scene.problem.lattice.element_count,
                   {},         {}};
  if (check.quantity == "deflection") found.figures = {deflection(check, scene)};
  if (check.quantity == "frequencies") found.figures = frequencies(check, scene.problem);
  if (check.quantity == "critical_load") found.figures = {critical_load(check, set)};
  const double scale = check.scale.is_present() ? check.scale(scene.parameters) : 1;
  for (double& figure : found.figures) figure *= scale;
  found.theory = theory_of(check, scene.parameters);
  return found;
}

/// Compares a figure with theory, extrapolates the three finest refinements so far, and sets the
/// status.
void judge(const ContinuumCheck& check, const std::vector<Refinement>& found, std::size_t mode,
           Record& row) {
  const std::size_t last = found.size() - 1;
  const auto error = [&](std::size_t n) {
    return found[n].figures[mode] / found[n].theory[mode] - 1;
  };
  row["error"] = number_text(error(last));
  if (last > 0)
    row["order"] = number_text(std::log(std::abs(error(last - 1) / error(last))) /
                               std::log(found[last - 1].spacing / found[last].spacing));
  Richardson limit{none, none};
  if (last > 1) {
    const auto three = [&](auto&& of) {
      return std::vector<double>{of(last - 2), of(last - 1), of(last)};
    };
    limit = richardson(three([&](std::size_t n) { return found[n].spacing; }),
                       three([&](std::size_t n) { return found[n].figures[mode]; }));
    row["richardson_order"] = number_text(limit.order);
    row["richardson_limit"] = number_text(limit.limit);
    row["limit_error"] = number_text(limit.limit / found[last].theory[mode] - 1);
  }
  row["status"] = found[last].value < check.bar_at ? "coarse" : "passed";
  if (row["status"] == "passed" && !(std::abs(error(last)) <= check.bar)) {
    row["status"] = "failed";
    row["reason"] = fmt::format("{:.2g} from theory, {:g} is allowed", error(last), check.bar);
  }
  const bool is_finest = last + 1 == check.values.size() && last > 1;
  if (is_finest && check.order > 0 &&
      !(std::abs(limit.order - check.order) <= check.order_within)) {
    row["status"] = "failed";
    row["reason"] = fmt::format("order {:.3g}, {:g} was declared", limit.order, check.order);
  }
}

Record row_of(const ContinuumStudy& study, const ContinuumCheck& check, double value) {
  return {{"experiment", study.name},      {"check", check.name},
          {"quantity", check.quantity},    {"set", set_text(check.set)},
          {"refined", check.refined},      {"value", number_text(value)},
          {"bar", number_text(check.bar)}, {"bar_at", number_text(check.bar_at)},
          {"source", check.source}};
}

void add_rows(const ContinuumStudy& study, const ContinuumCheck& check, Table& table) {
  std::vector<Refinement> found;
  for (const double value : check.values) {
    Record row = row_of(study, check, value);
    try {
      found.push_back(refinement(check, value));
    } catch (const std::exception& error) { // the other checks continue
      row["status"] = "failed";
      row["reason"] = error.what();
      table.rows.push_back(std::move(row));
      return;
    }
    const Refinement& now = found.back();
    row["scene"] = now.scene;
    row["elements"] = fmt::format("{}", now.elements);
    row["spacing_m"] = number_text(now.spacing);
    for (std::size_t mode = 0; mode < now.figures.size(); ++mode) {
      row["mode"] = fmt::format("{}", mode + 1);
      row["figure"] = number_text(now.figures[mode]);
      row["theory"] = number_text(now.theory[mode]);
      judge(check, found, mode, row);
      table.rows.push_back(row);
      row["reason"].clear();
    }
  }
}

} // namespace

Table continuum_table(const ContinuumStudy& study) {
  Table table{continuum_columns, {}};
  for (const ContinuumCheck& check : study.checks) add_rows(study, check, table);
  return table;
}

std::string continuum_text(const ContinuumStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows) {
    const auto own = [&](const char* column, const char* form) { return shown(row, column, form); };
    rows.push_back({text_in(row, "check"), text_in(row, "mode"),
                    text_in(row, "refined") + "=" + own("value", "{:g}"), own("figure", "{:.6g}"),
                    own("theory", "{:.6g}"), own("error", "{:+.2e}"), own("order", "{:.2f}"),
                    own("richardson_order", "{:.2f}"), own("limit_error", "{:+.2e}"),
                    text_in(row, "status"), text_in(row, "reason")});
  }
  return fmt::format("{} ({})\n{}", study.title, study.name,
                     text_table({"check", "mode", "refined", "figure", "theory", "error", "order",
                                 "Richardson's", "limit's error", "status", ""},
                                rows));
}

} // namespace dss
