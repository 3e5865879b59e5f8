#include "experiments/measure/cell_reader.hpp"
#include "experiments/measure/study_names.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

Scale read_scale(const JsonPlace& place, const std::string& name, const CellRules& rules) {
  std::vector<std::string> keys{"set",          "steps",       "steps_by_set", "full_steps",
                                "oracle_steps", "tail_checks", "warmup_steps", "steps_for",
                                "repetitions",  "retries",     "half_width",   "budget_s",
                                "time_limit_s"};
  keys.insert(keys.end(), rules.scale_keys.begin(), rules.scale_keys.end());
  place.require_keys(keys);
  Scale scale;
  scale.name = name;
  if (!rules.expand) scale.steps = place["steps"].count(1);
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

void require_cell_of(const std::string& variant, const CellStudy& study, const JsonPlace& place) {
  known_variant(variant, place);
  if (std::none_of(study.cells.begin(), study.cells.end(),
                   [&](const Cell& cell) { return cell.variant == variant; }))
    place.fail(fmt::format("no cell of the study has the variant \"{}\"", variant));
}

/// Rejects steps for overrides that no cell has: they would have no effect.
void require_sets(const JsonPlace& steps_by_set, const CellStudy& study) {
  for (const auto& own : study.scale.steps_by_set)
    if (std::none_of(study.cells.begin(), study.cells.end(),
                     [&](const Cell& cell) { return cell.set_text() == own.first; }))
      steps_by_set.fail(fmt::format("no cell has the overrides \"{}\"; the first cell has \"{}\"",
                                    own.first, study.cells[0].set_text()));
}

/// Doubles the first cell of a variant on 1 rank, in each problem of the study. The ratio of the
/// two is the resolution of the measurement.
void add_twins(const std::string& variant, CellStudy& study) {
  std::vector<Cell> twins;
  for (const Cell& cell : study.cells) {
    const bool has_one = std::any_of(twins.begin(), twins.end(), [&](const Cell& twin) {
      return twin.problem_key() == cell.problem_key();
    });
    if (cell.variant != variant || cell.ranks > 1 || !cell.skipped.empty() || has_one) continue;
    twins.push_back(cell);
    twins.back().is_twin = true;
  }
  study.cells.insert(study.cells.end(), twins.begin(), twins.end());
}

} // namespace

void read_cells(const StudyFile& file, const CellRules& rules, CellStudy& study) {
  const JsonPlace& root = file.root;
  study.name = file.name, study.title = file.title, study.path = file.path;
  study.scale = read_scale(file.scale, file.scale_name, rules);
  const Sets scale_sets = combinations(file.scale, "set");
  for (const JsonPlace& block : root["cells"].items()) add_block(block, scale_sets, rules, study);
  if (study.cells.empty()) root["cells"].fail("no cell; give at least one scene with a variant");
  if (file.scale.has("steps_by_set")) require_sets(file.scale["steps_by_set"], study);
  if (root.has("base")) study.bases = root["base"].texts();
  for (const std::string& base : study.bases) require_cell_of(base, study, root["base"]);
  if (!root.has("twin")) return;
  require_cell_of(root["twin"].text(), study, root["twin"]);
  add_twins(root["twin"].text(), study);
}

} // namespace dss
