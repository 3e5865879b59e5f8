#include "experiments/studies/stability/stability_study.hpp"
#include "experiments/base/parallel.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/stability/stability_energy.hpp"
#include "experiments/run/stability/stability_limit.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

StabilityStudy::Case mode_case(const std::string& scene, double zeta) {
  const std::string text = fmt::format("{:g}", zeta);
  return {std::filesystem::path(scene).stem().string(), "zeta=" + text,
          load_scene(scene, {{"zeta", text}}), zeta};
}

void read_mode(const Node& node, ObjectNode& scale, const std::string& file,
               StabilityStudy& study) {
  ObjectNode object(node);
  const Node name = object.require("scene");
  std::vector<double> zetas = object.require("zeta").non_negatives();
  if (const auto own = scale.find("zeta")) zetas = own->non_negatives();
  object.finish();
  const std::string scene = scene_beside(file, name.name());
  const Scene as_it_is = load_scene(scene, {});
  for (const char* parameter : {"omega", "zeta"})
    if (!as_it_is.parameters.contains(parameter))
      name.fail(fmt::format("has no parameter \"{}\"; give a scene of one mode", parameter));
  study.undamped = mode_case(scene, 0);
  for (const double zeta : zetas) study.cases.push_back(mode_case(scene, zeta));
}

void read_scene_cases(const Node& node, std::size_t most_elements, const std::string& file,
                      StabilityStudy& study) {
  ObjectNode object(node);
  const std::string name = object.require("scene").name(), scene = scene_beside(file, name);
  const Sets sets = combinations(object, "set");
  object.finish();
  for (const std::vector<Override>& set : sets) {
    StabilityStudy::Case own{name, set_text(set), load_scene(scene, set), {}};
    if (own.scene.problem.lattice.element_count <= most_elements)
      study.cases.push_back(std::move(own));
  }
}

std::string number_or_nothing(double value) {
  return std::isfinite(value) ? number_text(value) : "";
}

Record limit_row(const StabilityStudy& study, const StabilityStudy::Case& of,
                 const LimitComparison& limit) {
  const Mode& mode = limit.predicted.mode;
  const bool is_measured = limit.measured.runs > 0;
  const double measured = is_measured ? limit.measured.dt : std::nan("");
  return {{"experiment", study.name},
          {"scene", of.name},
          {"set", of.set},
          {"variant", study.plugin->name},
          {"integrator", std::string(limit.method->name)},
          {"elements", fmt::format("{}", of.scene.problem.lattice.element_count)},
          {"zeta", number_or_nothing(of.zeta ? *of.zeta : mode.rate / (2 * mode.omega))},
          {"omega_rad_per_s", number_text(mode.omega)},
          {"predicted_dt_s", number_or_nothing(limit.predicted.dt)},
          {"measured_dt_s", number_text(measured)},
          {"ratio", number_or_nothing(measured / limit.predicted.dt)},
          {"predicted_h_omega", number_or_nothing(limit.predicted.dt * mode.omega)},
          {"measured_h_omega", number_or_nothing(measured * mode.omega)},
          {"prediction", limit.predicted.how},
          {"mode", mode_text(limit.predicted)},
          {"steps", is_measured ? fmt::format("{}", limit.measured.steps) : ""},
          {"runs", is_measured ? fmt::format("{}", limit.measured.runs) : ""},
          {"status", limit.status},
          {"reason", limit.reason}};
}

std::vector<const Method*> explicit_methods() {
  std::vector<const Method*> all;
  for (const Method& method : methods()) all.push_back(&method);
  return all;
}

/// Points evenly spaced in the logarithm.
double between(double first, double last, int n, int points) {
  return first * std::pow(last / first, double(n) / (points - 1));
}

} // namespace

StabilityStudy read_stability(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("stability"));
  StabilityStudy study;
  study.name = file.name;
  study.title = file.title;
  const std::string variant = object.name_or("variant", "auto");
  if (variant != "auto") known_variant(variant, object.require("variant"));
  study.plugin = &load_variant(variant);
  study.element_steps = scale.positive_or("element_steps", usual_element_steps);
  study.energy_points = scale.require("energy_points").count(2);
  study.map_points = scale.require("map_points").count(2);
  const auto most = std::size_t(scale.whole_or("most_elements", 1, Node::most_whole));
  const Node mode = object.require("mode"), scenes = object.require("scenes");
  object.finish();
  read_mode(mode, scale, file.path, study);
  scale.finish();
  for (const Node& scene : scenes.items()) read_scene_cases(scene, most, file.path, study);
  return study;
}

Table stability_table(const StabilityStudy& study) {
  Table table{{"experiment", "scene", "set", "variant", "integrator", "elements", "zeta",
               "omega_rad_per_s", "predicted_dt_s", "measured_dt_s", "ratio", "predicted_h_omega",
               "measured_h_omega", "prediction", "mode", "steps", "runs", "status", "reason"},
              {}};
  const std::vector<const Method*> all = explicit_methods();
  table.rows.resize(study.cases.size() * all.size());
  std::vector<std::vector<StabilityLimit>> predicted(study.cases.size());
  for_each_on_all_cores(study.cases.size(), [&](std::size_t c) {
    predicted[c] = stable_steps(study.cases[c].scene.problem, all);
  });
  const auto measure = [&](std::size_t n) {
    const std::size_t m = n % all.size();
    const StabilityStudy::Case& of = study.cases[n / all.size()];
    table.rows[n] = limit_row(study, of,
                              compare_limit(*study.plugin, of.scene.problem, *all[m],
                                            predicted[n / all.size()][m], study.element_steps));
  };
  // Variants on ranks or devices, and those that compute by other variants, have threads of their
  // own or must stay on the main thread.
  if (const Plugin& plugin = *study.plugin; plugin.kernels != nullptr || plugin.has_all)
    for_each_on_all_cores(table.rows.size(), measure);
  else
    for (std::size_t n = 0; n < table.rows.size(); ++n) measure(n);
  return table;
}

Table stability_energy_table(const StabilityStudy& study) {
  Table table{{"experiment", "scene", "variant", "integrator", "h_omega",
               "theory_energy_change_per_step", "measured_energy_change_per_step", "steps",
               "status"},
              {}};
  const Scene& scene = study.undamped->scene;
  for (const Method& method : methods())
    for (const double h_omega : energy_range(method, study.energy_points)) {
      const EnergyPoint point = energy_change(*study.plugin, scene.problem, method,
                                              scene.parameters.at("omega"), h_omega);
      table.rows.push_back({{"experiment", study.name},
                            {"scene", study.undamped->name},
                            {"variant", study.plugin->name},
                            {"integrator", std::string(method.name)},
                            {"h_omega", number_text(h_omega)},
                            {"theory_energy_change_per_step", number_text(point.theory)},
                            {"measured_energy_change_per_step", number_text(point.measured)},
                            {"steps", fmt::format("{}", point.steps)},
                            {"status", point.is_as_predicted() ? "ok" : "failed"}});
    }
  return table;
}

Table stability_map_table(const StabilityStudy& study) {
  Table table{{"integrator", "zeta", "h_omega", "spectral_radius", "limit_h_omega"}, {}};
  constexpr double least_zeta = 1e-3, most_zeta = 20, least_step = 0.02;
  std::vector<double> zetas = {1}; // limits have a kink here
  for (int z = 0; z < study.map_points; ++z)
    zetas.push_back(between(least_zeta, most_zeta, z, study.map_points));
  std::ranges::sort(zetas);
  for (const Method& method : methods()) {
    const double most_step =
        2 * std::max(mode_step_limit(method, 1, 0.2), mode_step_limit(method, 1, 1));
    for (const double zeta : zetas) {
      const double limit = mode_step_limit(method, 1, 2 * zeta);
      for (int n = 0; n < study.map_points; ++n) {
        const double h = between(least_step, most_step, n, study.map_points);
        table.rows.push_back(
            {{"integrator", std::string(method.name)},
             {"zeta", fmt::format("{:.6g}", zeta)},
             {"h_omega", fmt::format("{:.6g}", h)},
             {"spectral_radius", fmt::format("{:.6g}", spectral_radius(method, h, 1, 2 * zeta))},
             {"limit_h_omega", fmt::format("{:.6g}", limit)}});
      }
    }
  }
  return table;
}

std::string stability_text(const StabilityStudy& study, const Table& limits, const Table& energy) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : limits.rows) {
    const auto own = [&](const char* column, const char* form) { return shown(row, column, form); };
    rows.push_back({text_in(row, "scene"), text_in(row, "set"), text_in(row, "integrator"),
                    own("zeta", "{:.4g}"), own("predicted_dt_s", "{:.5g}"),
                    own("measured_dt_s", "{:.5g}"), own("ratio", "{:.4f}"),
                    own("predicted_h_omega", "{:.4f}"), text_in(row, "status"),
                    text_in(row, "reason")});
  }
  const auto wrong = std::ranges::count_if(
      energy.rows, [](const Record& row) { return text_in(row, "status") != "ok"; });
  return fmt::format(
      "{} ({}), variant {}\n{}\nEnergy of an undamped mode: {} of {} figures as in theory\n",
      study.title, study.name, study.plugin->name,
      text_table({"scene", "set", "integrator", "zeta", "predicted [s]", "measured [s]", "ratio",
                  "h omega", "status", "reason"},
                 rows),
      energy.rows.size() - std::size_t(wrong), energy.rows.size());
}

} // namespace dss
