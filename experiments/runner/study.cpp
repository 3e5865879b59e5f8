#include "experiments/runner/study.hpp"
#include "experiments/runner/keyed_study.hpp"
#include "experiments/runner/study_block.hpp"
#include "experiments/runner/study_reader.hpp"
#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

namespace fs = std::filesystem;

/// Cells of precision have steps of their own.
Scale read_scale(const JsonPlace& place, const std::string& name, bool is_of_precision) {
  place.require_keys({"set", "steps", "steps_by_set", "full_steps", "oracle_steps", "tail_checks", "warmup_steps",
                      "steps_for", "repetitions", "retries", "half_width", "budget_s", "time_limit_s", "shorten",
                      "repeat_for", "halvings"});
  Scale scale;
  scale.name = name;
  if (!is_of_precision) scale.steps = place["steps"].count(1);
  if (place.has("shorten")) scale.shorten = place["shorten"].positive();
  if (place.has("repeat_for")) scale.repeat_for = place["repeat_for"].positive();
  if (place.has("halvings")) scale.halvings = place["halvings"].whole_numbers();
  scale.oracle_steps = place.has("oracle_steps") ? place["oracle_steps"].count(1) : scale.steps;
  if (place.has("full_steps")) scale.full_steps = place["full_steps"].count(1);
  if (place.has("tail_checks")) scale.tail_checks = place["tail_checks"].count(1);
  if (place.has("warmup_steps")) scale.warmup_steps = place["warmup_steps"].count(0);
  if (place.has("retries")) scale.retries = place["retries"].count(0);
  if (place.has("half_width")) scale.half_width = place["half_width"].positive();
  if (place.has("budget_s")) scale.budget_s = place["budget_s"].positive();
  if (place.has("time_limit_s")) scale.time_limit_s = place["time_limit_s"].positive();
  if (place.has("steps_for"))
    for (const auto& [slow, steps] : place["steps_for"].value().items()) {
      known_variant(slow.substr(0, slow.find(' ')), place["steps_for"]);
      scale.steps_for[slow] = place["steps_for"][slow].count(1);
    }
  if (place.has("steps_by_set"))
    for (const auto& [set, steps] : place["steps_by_set"].value().items())
      scale.steps_by_set[set] = place["steps_by_set"][set].count(1);
  if (place.has("repetitions")) {
    const auto limits = place["repetitions"].items();
    if (limits.size() != 2) place["repetitions"].fail("is not [least, most]");
    scale.min_repetitions = limits[0].count(1);
    scale.max_repetitions = limits[1].count(scale.min_repetitions);
  }
  return scale;
}

void require_cell_of(const std::string& variant, const Study& study, const JsonPlace& place) {
  known_variant(variant, place);
  if (std::none_of(study.cells.begin(), study.cells.end(), [&](const Cell& cell) { return cell.variant == variant; }))
    place.fail(fmt::format("no cell of the study has the variant \"{}\"", variant));
}

/// Steps for overrides that no cell has would be a mistake without consequences.
void require_sets(const JsonPlace& steps_by_set, const Study& study) {
  for (const auto& own : study.scale.steps_by_set)
    if (std::none_of(study.cells.begin(), study.cells.end(),
                     [&](const Cell& cell) { return cell.set_text() == own.first; }))
      steps_by_set.fail(fmt::format("no cell has the overrides \"{}\"; the first cell has \"{}\"", own.first,
                                    study.cells[0].set_text()));
}

void read_paper(const JsonPlace& place, Study& study) {
  place.require_keys({"source", "rows"});
  study.paper_source = place["source"].text();
  for (const JsonPlace& row : place["rows"].items()) {
    row.require_keys({"label", "set", "wall_s", "speedup"});
    study.paper.push_back({row["label"].text(), row["wall_s"].positive(),
                           row.has("speedup") ? row["speedup"].positive() : 0,
                           row.has("set") ? row["set"].text() : ""});
  }
}

/// Doubles the first cell of a variant on 1 rank, in each problem of the study: their ratio shows what the measurement can
/// tell apart.
void add_twins(const std::string& variant, Study& study) {
  std::vector<Cell> twins;
  for (const Cell& cell : study.cells) {
    const bool has_one = std::any_of(twins.begin(), twins.end(),
                                     [&](const Cell& twin) { return twin.problem_key() == cell.problem_key(); });
    if (cell.variant != variant || cell.ranks > 1 || !cell.skipped.empty() || has_one) continue;
    twins.push_back(cell);
    twins.back().is_twin = true;
  }
  study.cells.insert(study.cells.end(), twins.begin(), twins.end());
}

fs::path study_directory() {
  if (const char* directory = std::getenv("DSSBENCH_EXPERIMENTS")) return directory;
  return program_file("experiments");
}

} // namespace

std::string set_text(const std::vector<Override>& set) {
  std::string text;
  for (const Override& item : set) text += fmt::format("{}{}={}", text.empty() ? "" : " ", item.key, item.value);
  return text;
}

std::string Cell::set_text() const { return dss::set_text(set); }

std::string Cell::step_text() const {
  return (dt > 0 ? fmt::format(" dt {:.6g} s", dt) : "") + (rtol > 0 ? fmt::format(" rtol {:g}", rtol) : "");
}

std::string Cell::problem_key() const {
  return fmt::format("{} {} {} {} {}{} {} steps", scene, set_text(), model, precision, integrator, step_text(), steps);
}

std::string Cell::key() const {
  // A cell on 1 rank is named as before there were ranks, so that results can still be compared with earlier ones.
  const std::string on_ranks = ranks == 1 ? "" : fmt::format("r{} {} {} ", ranks, decomposition, halo);
  return fmt::format("{} {} {}{}{} {}t{} {} {} {}{} {} steps{}", scene, set_text(), variant,
                     hybrid.empty() ? "" : "[" + hybrid + "]", device.empty() ? "" : "@" + device, on_ranks, threads,
                     model, precision, integrator, step_text(), steps, is_twin ? " (A/A)" : "");
}

std::string Cell::label() const {
  const std::string team = fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
  const std::string twin = is_twin ? " (A/A)" : "";
  const std::string on_device = device.empty() ? "" : " on " + device;
  if (!hybrid.empty() && hybrid != "auto") return fmt::format("hybrid {}{}", hybrid, twin);
  if (!hybrid.empty()) return fmt::format("hybrid auto, {}{}{}", team, device.empty() ? "" : ", with " + device, twin);
  if (ranks == 1) return fmt::format("{}{}, {}{}", variant, on_device, team, twin);
  return fmt::format("{}, {} ranks x {}, halo {}{}{}", variant, ranks, team, halo,
                     decomposition == "strips" ? "" : ", " + decomposition, twin);
}

std::vector<StudyListing> list_studies() {
  std::vector<StudyListing> listings;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(study_directory(), error)) {
    if (entry.path().extension() != ".json") continue;
    const nlohmann::json json = parse_json_file(entry.path().string());
    listings.push_back({entry.path().stem().string(), json.value("title", ""), entry.path().string()});
  }
  std::sort(listings.begin(), listings.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return listings;
}

std::string study_path(const std::string& name_or_path) {
  if (name_or_path.ends_with(".json") || name_or_path.find('/') != std::string::npos) {
    if (fs::exists(name_or_path)) return name_or_path;
  }
  std::vector<std::string> names;
  for (const StudyListing& listing : list_studies()) {
    if (listing.name == name_or_path || listing.name + ".json" == name_or_path) return listing.path;
    names.push_back(listing.name);
  }
  throw InputError(fmt::format("{}: no such experiment; {}", name_or_path, nearest_name(name_or_path, names)));
}

std::vector<std::string> scale_names(const std::string& name_or_path) {
  std::vector<std::string> names;
  try {
    const nlohmann::json json = parse_json_file(study_path(name_or_path));
    if (json.is_object() && json.contains("scales"))
      for (const auto& [name, scale] : json["scales"].items()) names.push_back(name);
  } catch (const InputError&) {
  }
  return names;
}

Study load_study(const std::string& name_or_path, const std::string& scale, int cores) {
  Study study;
  study.path = study_path(name_or_path);
  const nlohmann::json json = parse_json_file(study.path);
  const JsonPlace root(json, study.path);
  root.require_keys(
      {"experiment", "title", "cells", "base", "twin", "paper", "scales", "simulation", "work_precision"});
  if (root.has("work_precision"))
    root.must_have({"experiment", "title", "cells", "scales"});
  else
    root.must_have({"experiment", "title", "cells", "base", "scales"});
  study.name = root["experiment"].text();
  if (study.name.find_first_of("/ ") != std::string::npos) root["experiment"].fail("names files: no slash, no space");
  study.title = root["title"].text();
  const JsonPlace scale_place = scale_of(root, scale);
  study.scale = read_scale(scale_place, scale, root.has("work_precision"));
  if (root.has("work_precision")) study.precision = read_precision_rules(root["work_precision"]);
  const Sets scale_sets = combinations(scale_place, "set");
  for (const JsonPlace& block : root["cells"].items()) add_block(block, scale_sets, cores, study);
  if (study.cells.empty()) root["cells"].fail("no cell; give at least one scene with a variant");
  if (scale_place.has("steps_by_set")) require_sets(scale_place["steps_by_set"], study);
  if (!study.precision || root.has("base")) study.bases = root["base"].texts();
  for (const std::string& base : study.bases) require_cell_of(base, study, root["base"]);
  if (root.has("twin")) {
    require_cell_of(root["twin"].text(), study, root["twin"]);
    add_twins(root["twin"].text(), study);
  }
  if (root.has("paper")) read_paper(root["paper"], study);
  return study;
}

} // namespace dss
