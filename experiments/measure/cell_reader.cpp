#include "experiments/measure/cell_reader.hpp"
#include "experiments/measure/study_names.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

std::map<std::string, long> read_steps(ObjectNode& scale, const char* key) {
  std::map<std::string, long> steps;
  if (const auto node = scale.find(key))
    for (const auto& [cells, count] : ObjectNode(*node).members()) steps[cells] = count.whole(1);
  return steps;
}

void read_repetitions(const Node& node, Scale& scale) {
  const std::vector<Node> limits = node.items();
  if (limits.size() != 2) node.fail("is not [least, most]");
  scale.min_repetitions = limits[0].whole(1);
  scale.max_repetitions = limits[1].whole(scale.min_repetitions);
}

Scale read_scale(const StudyFile& file, const CellRules& rules) {
  ObjectNode object(file.scale);
  object.allow({"set"});
  object.allow(rules.scale_keys);
  Scale scale;
  scale.name = file.scale_name;
  if (!rules.expand) scale.steps = object.require("steps").whole(1);
  scale.oracle_steps = object.whole_or("oracle_steps", 1, scale.steps);
  scale.full_steps = object.whole_or("full_steps", 1, scale.full_steps);
  scale.tail_checks = object.whole_or("tail_checks", 1, scale.tail_checks);
  scale.warmup_steps = object.whole_or("warmup_steps", 0, scale.warmup_steps);
  scale.warmup_s = object.non_negative_or("warmup_s", scale.warmup_s);
  scale.samples = object.whole_or("samples", 1, scale.samples);
  scale.retries = object.whole_or("retries", 0, scale.retries);
  scale.half_width = object.positive_or("half_width", scale.half_width);
  scale.budget_s = object.positive_or("budget_s", scale.budget_s);
  scale.patience_s =
      object.non_negative_or("patience_s", scale.retries > 0 ? 0.5 * scale.budget_s : 0);
  scale.time_limit_s = object.positive_or("time_limit_s", scale.time_limit_s);
  scale.steps_by_set = read_steps(object, "steps_by_set");
  scale.steps_for = read_steps(object, "steps_for");
  scale.whole_once = object.names_or("whole_once", {});
  if (!scale.whole_once.empty() && scale.steps_for.empty())
    object.require("whole_once").fail("no variant has fewer steps: there is no \"steps_for\"");
  for (const std::string& variant : scale.whole_once)
    known_variant(variant, object.require("whole_once"));
  for (const auto& slow : scale.steps_for)
    known_variant(slow.first.substr(0, slow.first.find(' ')), object.require("steps_for"));
  if (const auto limits = object.find("repetitions")) read_repetitions(*limits, scale);
  object.finish();
  return scale;
}

void require_cell_of(const std::string& variant, const CellStudy& study, const Node& place) {
  known_variant(variant, place);
  if (std::none_of(study.cells.begin(), study.cells.end(),
                   [&](const Cell& cell) { return cell.variant == variant; }))
    place.fail(fmt::format("no cell of the study has the variant \"{}\"", variant));
}

/// Rejects steps for overrides that no cell has: they would have no effect.
void require_sets(const Node& steps_by_set, const CellStudy& study) {
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
    if (cell.variant != variant || cell.ranks > 1 || cell.is_whole_once || !cell.skipped.empty() ||
        has_one)
      continue;
    twins.push_back(cell);
    twins.back().is_twin = true;
  }
  study.cells.insert(study.cells.end(), twins.begin(), twins.end());
}

/// Adds a cell of all steps for each cell that is scaled and whose variant is in `whole_once`.
void add_whole_runs(int cores, CellStudy& study) {
  std::vector<Cell> whole;
  for (const Cell& cell : study.cells)
    if (std::ranges::find(study.scale.whole_once, cell.variant) != study.scale.whole_once.end() &&
        cell.steps < cell.full_steps && !cell.is_oversubscribed(cores) && cell.skipped.empty()) {
      whole.push_back(cell);
      whole.back().steps = cell.full_steps;
      whole.back().is_whole_once = true;
    }
  study.cells.insert(study.cells.end(), whole.begin(), whole.end());
}

} // namespace

void read_cells(const StudyFile& file, const CellRules& rules, CellStudy& study) {
  ObjectNode root(file.root), scale(file.scale);
  study.name = file.name, study.title = file.title, study.path = file.path;
  study.scale = read_scale(file, rules);
  StudyScales scales{{}, combinations(scale, "set")};
  for (const auto& [name, of_name] : root.require("scales").json().items())
    scales.names.push_back(name);
  for (const Node& block : root.require("cells").list()) add_block(block, scales, rules, study);
  if (study.cells.empty())
    root.require("cells").fail(fmt::format("every block is \"not_at\" the scale \"{}\"; one must "
                                           "have cells there",
                                           study.scale.name));
  if (const auto steps = scale.find("steps_by_set")) require_sets(*steps, study);
  add_whole_runs(rules.cores, study);
  study.bases = root.names_or("base", {});
  for (const std::string& base : study.bases) require_cell_of(base, study, root.require("base"));
  const auto twin = root.find("twin");
  if (!twin) return;
  require_cell_of(twin->name(), study, *twin);
  add_twins(twin->name(), study);
}

} // namespace dss
