#include "experiments/cli/sweep_study.hpp"
#include "experiments/base/child.hpp"
#include "experiments/measure/cell_record.hpp"
#include "solver/error.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace dss {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr long least_steps = 2; ///< the oracle checks so many
constexpr long samples = 3;     ///< of a repetition; bases take twice as many
constexpr std::size_t most_cells = 1000;
constexpr double trial_s = 0.05, trial_limit_s = 120;

/// A number if the text is one, else the text: an expression, or a word such as "cores".
Json value_of(const std::string& text) {
  const Json number = Json::parse(text, nullptr, false);
  return number.is_number() ? number : Json(text);
}
Json values_of(const Names& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(value_of(text));
  return list;
}

/// A scene's file is named by its absolute path, because a study can be run from any folder.
std::string scene_for_study(const std::string& scene) {
  const bool is_file = scene.ends_with(".json") || scene.find('/') != std::string::npos;
  return is_file && std::filesystem::exists(scene)
             ? std::filesystem::absolute(scene).lexically_normal().string()
             : scene;
}

std::string base_of(const SweepRequest& request) {
  const std::string& base = request.base.empty() ? request.variants.front() : request.base;
  return base == "auto" ? load_variant(base).name : base;
}

Json sets_of(const SweepRequest& request) {
  Json sets = Json::object();
  for (const std::string& text : request.set) {
    const auto [key, values] = values_of_set(text);
    if (sets.contains(key))
      throw InputError(
          fmt::format("--set {}: {} has values already; give all of them at once", text, key));
    sets[key] = values_of(values);
  }
  return sets;
}

/// Whether a variant computes on no device. Those that are unknown or cannot run here may have one:
/// the study says what is wrong with them.
bool is_without_device(const std::string& variant) {
  const auto found = std::ranges::find(asked_variants(), variant, &VariantStatus::name);
  return variant == "auto" || (found != asked_variants().end() && found->is_usable() &&
                               load_variant(variant).devices == nullptr);
}

Json block_of(const SweepRequest& request, const Names& variants, const Names& threads,
              const Names& ranks) {
  Json block = {{"scene", scene_for_study(request.scene)}};
  if (!request.set.empty()) block["set"] = sets_of(request);
  block["variants"] = variants;
  block["threads"] = values_of(threads);
  block["ranks"] = values_of(ranks);
  const auto add = [&](const char* key, const Names& names) {
    if (!names.empty()) block[key] = names;
  };
  add("models", request.models), add("precisions", request.precisions);
  add("integrators", request.integrators);
  if (!request.members.empty()) block["ensemble"] = values_of(request.members);
  if (!request.device.empty() && !is_without_device(variants.front()))
    block["device"] = request.device;
  if (ranks != Names{"1"})
    add("halos", request.halos), add("decompositions", request.decompositions);
  return block;
}

/// All cells: those of the base, and every combination. If a device is given, variants that compute
/// on devices have a block of their own.
Json blocks_of(const SweepRequest& request, const std::string& base) {
  Json blocks = Json::array({block_of(request, {base}, {"1"}, {"1"})});
  Names here, on_devices;
  for (const std::string& variant : request.variants)
    (request.device.empty() || is_without_device(variant) ? here : on_devices).push_back(variant);
  for (const Names& variants : {here, on_devices})
    if (!variants.empty())
      blocks.push_back(block_of(request, variants, request.threads, request.ranks));
  return blocks;
}

/// CLI11's ranges let nan pass.
void require_time(const char* option, double value, double least, double most) {
  if (!(value >= least && value <= most))
    throw InputError(fmt::format("{} {:g}: give {:g} to {:g} s", option, value, least, most));
}

void require_sound(const SweepRequest& request) {
  require_time("--sample-time", request.sample_s, 1e-3, 60);
  require_time("--budget", request.budget_s, 1e-3, 1e6);
  std::size_t cells = 1;
  for (const std::string& text : request.set) cells *= values_of_set(text).second.size();
  for (const Names* names :
       {&request.variants, &request.threads, &request.ranks, &request.models, &request.precisions,
        &request.integrators, &request.halos, &request.decompositions, &request.members}) {
    cells *= std::max<std::size_t>(1, names->size());
    if (cells > most_cells)
      throw InputError(
          fmt::format("sweep: more than {} combinations; give fewer values", most_cells));
  }
  const bool has_ranks = request.ranks != Names{"1"};
  if (!has_ranks && !(request.halos.empty() && request.decompositions.empty()))
    throw InputError("--halo, --decomposition: one process exchanges nothing; give --ranks");
  if (has_ranks && !request.members.empty())
    throw InputError("--ensemble: members run side by side on one rank; leave --ranks out");
  if (!request.device.empty() && is_without_device(base_of(request)) &&
      std::ranges::all_of(request.variants, is_without_device))
    throw InputError(fmt::format("--device {}: {} compute on this CPU; give opencl too, or leave "
                                 "--device out",
                                 request.device, fmt::join(request.variants, ", ")));
  for (const char* const variant : {"as_published", "reference"})
    if (has_ranks && std::ranges::find(request.variants, variant) != request.variants.end())
      throw InputError(fmt::format("--variant {0}: computes no part of a scene, so it runs on one "
                                   "rank; give it as --base {0}",
                                   variant));
}

/// Steps of the fastest cell of each variant for a sample, by overrides and variant. Without
/// overrides, the steps of one member also bound those of its ensembles, whose steps take longer.
std::map<std::string, std::map<std::string, long>> steps_of(const std::vector<CellRate>& rates,
                                                            double sample_s) {
  std::map<std::string, std::map<std::string, long>> steps;
  for (const CellRate& rate : rates) {
    long& most = steps[rate.set].try_emplace(rate.variant, least_steps).first->second;
    most = std::max(most, std::lround(std::ceil(1.2 * sample_s * rate.steps_per_s)));
  }
  return steps;
}

Json scale_of(const SweepRequest& request, const std::vector<CellRate>& rates) {
  Json scale = {{"steps", std::max(request.steps, least_steps)},
                {"oracle_steps", least_steps},
                {"tail_checks", 1},
                {"repetitions", {request.repetitions, 2 * request.repetitions}},
                {"samples", samples},
                {"budget_s", request.budget_s},
                {"time_limit_s", 3600}};
  const auto steps = steps_of(rates, request.sample_s);
  for (const auto& [set, of_variants] : steps) {
    long most = least_steps;
    for (const auto& [variant, count] : of_variants) {
      most = std::max(most, count);
      scale["steps_for"][set.empty() ? variant : variant + " " + set] = count;
    }
    scale["steps_by_set"][set] = most;
  }
  double slowest_s = 0;
  for (const CellRate& rate : rates)
    slowest_s = std::max(slowest_s, double(steps.at(rate.set).at(rate.variant)) / rate.steps_per_s);
  if (!rates.empty()) scale["time_limit_s"] = std::max(120., 3 * 2 * double(samples) * slowest_s);
  return scale;
}

/// Seconds of a step in a run of `cell.steps` steps; on one rank the run is repeated for a while.
double step_s(const CellStudy& study, const Cell& cell) {
  std::vector<std::string> more{"--no-balance"};
  if (cell.ranks == 1) more.insert(more.end(), {"--repeat-for", fmt::format("{:g}", trial_s)});
  const ChildResult child =
      run_child(this_program, run_arguments(study, cell, more), trial_limit_s);
  const nlohmann::json record = nlohmann::json::parse(child.output, nullptr, false);
  if (child.exit_code != 0 || !record.is_object() || !record.contains("wall_s") ||
      !record["wall_s"].is_number() || record["wall_s"].get<double>() <= 0)
    throw InputError(fmt::format("sweep: {} {}, {}: {}", cell.scene, cell.set_text(), cell.label(),
                                 child.failure(trial_limit_s)));
  return record["wall_s"].get<double>() / double(cell.steps);
}

} // namespace

std::string sweep_name(const SweepRequest& request) {
  if (request.name.find_first_of("/ ") != std::string::npos || request.name.starts_with("."))
    throw InputError(fmt::format("--name {}: names files; give no slash, no space and no dot first",
                                 request.name));
  if (!request.name.empty()) return request.name;
  std::string name = "sweep_" + std::filesystem::path(request.scene).stem().string();
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-') letter = '_';
  return name;
}

std::pair<std::string, std::vector<std::string>> values_of_set(const std::string& text) {
  const auto sign = text.find('=');
  Names values{""};
  int depth = 0;
  for (const char letter : sign == std::string::npos ? "" : text.substr(sign + 1)) {
    depth += (letter == '(' || letter == '[') - (letter == ')' || letter == ']');
    if (letter == ',' && depth == 0)
      values.emplace_back();
    else
      values.back() += letter;
  }
  if (sign == 0 || std::ranges::find(values, "") != values.end())
    throw InputError(fmt::format("--set {}: is not KEY=VALUE,..., such as n=40,80,160", text));
  return {text.substr(0, sign), values};
}

Json sweep_study(const SweepRequest& request, const std::vector<CellRate>& rates) {
  require_sound(request);
  const std::string base = base_of(request);
  const Names& swept = request.set.empty() ? request.variants : request.set;
  return {{"experiment", sweep_name(request)},
          {"title", fmt::format("Sweep of {}: {}", request.scene, fmt::join(swept, " "))},
          {"cells", blocks_of(request, base)},
          {"base", {base}},
          {"twin", base},
          {"scales", {{sweep_scale, scale_of(request, rates)}}}};
}

StudyFile sweep_file(const Json& study) {
  const auto json = std::make_shared<const JsonFile>("sweep", nlohmann::json(study));
  const Node root(*json);
  const Node scale = ObjectNode(ObjectNode(root).require("scales")).require(sweep_scale);
  return {json,
          "sweep",
          study.at("experiment").get<std::string>(),
          study.at("title").get<std::string>(),
          sweep_scale,
          root,
          scale};
}

std::vector<CellRate> trial_rates(const CellStudy& study, Progress& progress) {
  std::vector<CellRate> rates;
  std::string first_failure;
  double done = 0;
  for (const Cell& cell : study.cells) {
    progress.show(++done, double(study.cells.size()), "trial of " + cell.label());
    if (cell.is_twin || !cell.skipped.empty()) continue;
    try {
      // Few steps take longer each than many; so the second run has as many as the trial allows.
      Cell longer = cell;
      longer.steps = std::max(least_steps, std::lround(trial_s / step_s(study, cell)));
      rates.push_back({cell.set_text(), cell.variant, 1 / step_s(study, longer)});
    } catch (const InputError& failure) {
      if (first_failure.empty()) first_failure = failure.what();
    }
  }
  if (rates.empty() && !first_failure.empty()) throw InputError(first_failure);
  return rates;
}

} // namespace dss
