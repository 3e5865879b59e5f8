#include "experiments/cli/sweep_study.hpp"
#include "experiments/base/child.hpp"
#include "experiments/measure/cell_record.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

using Json = nlohmann::ordered_json;

constexpr long least_steps = 2; ///< the oracle checks so many
constexpr double trial_s = 0.05, trial_limit_s = 120;

/// A number if the text is one, else the text: an expression, or a word such as "cores".
Json value_of(const std::string& text) {
  const Json number = Json::parse(text, nullptr, false);
  return number.is_number() ? number : Json(text);
}
Json values_of(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(value_of(text));
  return list;
}

/// A scene's file is named as an absolute path, because the study lies in another folder.
std::string scene_for_study(const std::string& scene) {
  return scene.ends_with(".json") ? std::filesystem::absolute(scene).string() : scene;
}

std::string base_of(const SweepRequest& request) {
  return request.base.empty() ? request.variants.front() : request.base;
}

Json cells_of(const SweepRequest& request, const std::vector<std::string>& variants,
              const std::vector<std::string>& threads, const std::vector<std::string>& ranks) {
  Json block = {{"scene", scene_for_study(request.scene)}};
  for (const std::string& text : request.set) {
    const auto [key, values] = values_of_set(text);
    block["set"][key] = values_of(values);
  }
  block["variants"] = variants;
  block["threads"] = values_of(threads);
  block["ranks"] = values_of(ranks);
  const auto add = [&](const char* key, const std::vector<std::string>& names) {
    if (!names.empty()) block[key] = names;
  };
  add("models", request.models), add("precisions", request.precisions);
  add("integrators", request.integrators);
  if (ranks != std::vector<std::string>{"1"})
    add("halos", request.halos), add("decompositions", request.decompositions);
  return block;
}

Json scale_of(const SweepRequest& request, const SweepSteps& steps) {
  Json scale = {{"steps", std::max(request.steps, least_steps)},
                {"oracle_steps", least_steps},
                {"tail_checks", 1},
                {"repetitions", {request.repetitions, 2 * request.repetitions}},
                {"samples", 3},
                {"budget_s", request.budget_s},
                {"time_limit_s", trial_limit_s}};
  for (const auto& [set, of_variants] : steps) {
    long most = least_steps;
    for (const auto& [variant, count] : of_variants) {
      most = std::max(most, count);
      scale["steps_for"][set.empty() ? variant : variant + " " + set] = count;
    }
    scale["steps_by_set"][set] = most;
  }
  return scale;
}

/// Steps of a cell for a sample of this time, from a short run.
long steps_of_cell(const CellStudy& study, const Cell& cell, double sample_s) {
  const ChildResult child = run_child(
      this_program,
      run_arguments(study, cell, {"--no-balance", "--repeat-for", fmt::format("{:g}", trial_s)}),
      trial_limit_s);
  const nlohmann::json record = nlohmann::json::parse(child.output, nullptr, false);
  if (child.exit_code != 0 || !record.is_object())
    throw InputError(fmt::format("sweep: {} {}, {}: {}", cell.scene, cell.set_text(), cell.label(),
                                 child.failure(trial_limit_s)));
  const double steps_per_s =
      record.at("element_steps_per_s").get<double>() / record.at("elements").get<double>();
  return std::max(least_steps, std::lround(std::ceil(1.2 * sample_s * steps_per_s)));
}

} // namespace

std::string sweep_name(const SweepRequest& request) {
  if (!request.name.empty()) return request.name;
  std::string name = "sweep_" + std::filesystem::path(request.scene).stem().string();
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-') letter = '_';
  return name;
}

std::pair<std::string, std::vector<std::string>> values_of_set(const std::string& text) {
  const auto sign = text.find('=');
  const auto fail = [&] {
    throw InputError(fmt::format("--set {}: is not KEY=VALUE,..., such as n=40,80,160", text));
  };
  if (sign == std::string::npos || sign == 0) fail();
  std::vector<std::string> values{""};
  int depth = 0;
  for (const char letter : text.substr(sign + 1)) {
    depth += (letter == '(' || letter == '[') - (letter == ')' || letter == ']');
    if (letter == ',' && depth == 0)
      values.emplace_back();
    else
      values.back() += letter;
  }
  if (std::ranges::find(values, "") != values.end()) fail();
  return {text.substr(0, sign), values};
}

Json sweep_study(const SweepRequest& request, const SweepSteps& steps) {
  const std::string base = base_of(request);
  const std::string title =
      fmt::format("Sweep of {}: {}", request.scene,
                  fmt::join(request.set.empty() ? request.variants : request.set, " "));
  return {{"experiment", sweep_name(request)},
          {"title", title},
          {"cells",
           {cells_of(request, {base}, {"1"}, {"1"}),
            cells_of(request, request.variants, request.threads, request.ranks)}},
          {"base", {base}},
          {"twin", base},
          {"scales", {{sweep_scale, scale_of(request, steps)}}}};
}

SweepSteps trial_steps(const CellStudy& study, double sample_s) {
  SweepSteps steps;
  for (const Cell& cell : study.cells) {
    if (cell.is_twin || !cell.skipped.empty()) continue;
    long& most = steps[cell.set_text()][cell.variant];
    most = std::max(most, steps_of_cell(study, cell, sample_s));
  }
  return steps;
}

} // namespace dss
