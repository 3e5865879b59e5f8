#include "experiments/runner/study.hpp"
#include "experiments/runner/study_reader.hpp"
#include "solver/error.hpp"
#include "solver/model/model.hpp"
#include "solver/nearest_name.hpp"
#include "solver/numerics/method.hpp"
#include "variants/loader.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace dss {
namespace {

namespace fs = std::filesystem;
using Sets = std::vector<std::vector<Override>>;

std::string override_text(const JsonPlace& place) {
  const nlohmann::json& value = place.value();
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  place.fail(fmt::format("{} is neither a number nor a text", value.dump()));
}

/// Every combination of the values of an object like {"n": [50, 100], "run.dt": 1e-6}.
Sets combinations(const JsonPlace& place) {
  if (!place.value().is_object()) place.fail("is not an object of overrides, such as {\"n\": [50, 100]}");
  Sets sets(1);
  for (const auto& [key, value] : place.value().items()) {
    Sets longer;
    for (const auto& set : sets)
      for (const JsonPlace& item : place[key].items()) {
        longer.push_back(set);
        longer.back().push_back({key, override_text(item)});
      }
    sets = std::move(longer);
  }
  return sets;
}

std::vector<int> thread_counts(const JsonPlace& place, int cores) {
  std::vector<int> counts;
  for (const JsonPlace& item : place.items()) {
    if (item.value() == "cores")
      counts.push_back(cores);
    else if (item.value() == "1..cores") {
      for (int threads = 1; threads <= cores; ++threads) counts.push_back(threads);
    } else if (item.value().is_number_integer()) {
      counts.push_back(int(item.count(1)));
    } else {
      item.fail(fmt::format("{} is neither a number of threads nor \"cores\" nor \"1..cores\"", item.value().dump()));
    }
  }
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  return counts;
}

const VariantStatus& known_variant(const std::string& name, const JsonPlace& place) {
  std::vector<std::string> names;
  for (const VariantStatus& status : variants()) {
    if (status.name == name) return status;
    names.push_back(status.name);
  }
  place.fail(fmt::format("unknown variant \"{}\"; {}", name, nearest_name(name, names)));
}

Scale read_scale(const JsonPlace& scales, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [key, value] : scales.value().items()) known.push_back(key);
  if (!scales.has(name))
    throw InputError(fmt::format("--scale {}: unknown scale; {}", name, nearest_name(name, known)));
  const JsonPlace place = scales[name];
  place.require_keys({"set", "steps", "steps_by_set", "oracle_steps", "warmup_steps", "steps_for", "repetitions",
                      "retries", "half_width", "budget_s", "time_limit_s"});
  Scale scale;
  scale.name = name;
  scale.steps = place["steps"].count(1);
  scale.oracle_steps = place.has("oracle_steps") ? place["oracle_steps"].count(1) : scale.steps;
  if (place.has("warmup_steps")) scale.warmup_steps = place["warmup_steps"].count(0);
  if (place.has("retries")) scale.retries = place["retries"].count(0);
  if (place.has("half_width")) scale.half_width = place["half_width"].positive();
  if (place.has("budget_s")) scale.budget_s = place["budget_s"].positive();
  if (place.has("time_limit_s")) scale.time_limit_s = place["time_limit_s"].positive();
  if (place.has("steps_for"))
    for (const auto& [variant, steps] : place["steps_for"].value().items()) {
      known_variant(variant, place["steps_for"]);
      scale.steps_for[variant] = place["steps_for"][variant].count(1);
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

std::vector<std::string> names_or(const JsonPlace& block, const std::string& key, const char* otherwise) {
  return block.has(key) ? block[key].texts() : std::vector<std::string>{otherwise};
}

/// Whether a variant has more than one thread; unknown (and so no) where it cannot be opened.
bool is_threaded(const VariantStatus& status) { return status.is_usable() && load_variant(status.name).is_threaded; }

/// What a block of cells names, in every combination.
struct Block {
  Sets sets;
  std::vector<std::string> variants, models, precisions, integrators;
  std::vector<int> threads;
};

Block read_block(const JsonPlace& place, const Sets& scale_sets, int cores) {
  place.require_keys({"scene", "set", "variants", "threads", "models", "precisions", "integrators"});
  Block block;
  for (const auto& own : place.has("set") ? combinations(place["set"]) : Sets(1))
    for (const auto& of_scale : scale_sets) {
      block.sets.push_back(own);
      block.sets.back().insert(block.sets.back().end(), of_scale.begin(), of_scale.end());
    }
  block.variants = place["variants"].texts();
  block.threads = place.has("threads") ? thread_counts(place["threads"], cores) : std::vector<int>{1};
  block.models = names_or(place, "models", "spatial");
  block.precisions = names_or(place, "precisions", "f64");
  block.integrators = names_or(place, "integrators", "rk4");
  for (const std::string& name : block.variants) known_variant(name, place["variants"]);
  for (const std::string& name : block.models)
    if (!find_model(name)) place["models"].fail(fmt::format("unknown model \"{}\"; spatial, planar", name));
  for (const std::string& name : block.precisions)
    if (!find_precision(name)) place["precisions"].fail(fmt::format("unknown precision \"{}\"; f64, f32", name));
  for (const std::string& name : block.integrators)
    if (!find_method(name))
      place["integrators"].fail(fmt::format("unknown integrator \"{}\"; rk4, velocity_verlet", name));
  return block;
}

/// Refuses what cannot be run at all: an unknown scene or override, a planar model of what leaves the plane.
void require_loadable(const JsonPlace& place, const Block& block) {
  for (const auto& set : block.sets) {
    try {
      const Scene scene = load_scene(place["scene"].text(), set);
      const bool is_planar = std::find(block.models.begin(), block.models.end(), "planar") != block.models.end();
      if (const std::string why = why_not_planar(scene.problem); is_planar && !why.empty())
        throw InputError(fmt::format("model \"planar\": {}", why));
    } catch (const InputError& error) {
      place.fail(error.what());
    }
  }
}

/// Steps of a cell of this set, before `steps_for`.
long steps_of(const Scale& scale, const Cell& cell) {
  const auto own = scale.steps_by_set.find(cell.set_text());
  return own == scale.steps_by_set.end() ? scale.steps : own->second;
}

void add_cells(const JsonPlace& place, const Sets& scale_sets, int cores, Study& study) {
  const Block block = read_block(place, scale_sets, cores);
  require_loadable(place, block);
  Cell cell;
  cell.scene = place["scene"].text();
  for (const auto& set : block.sets)
    for (const std::string& model : block.models)
      for (const std::string& precision : block.precisions)
        for (const std::string& integrator : block.integrators)
          for (const std::string& variant : block.variants) {
            const VariantStatus& status = known_variant(variant, place["variants"]);
            const auto fewer = study.scale.steps_for.find(variant);
            cell.set = set;
            cell.full_steps = steps_of(study.scale, cell);
            cell.model = model;
            cell.precision = precision;
            cell.integrator = integrator;
            cell.variant = variant;
            cell.skipped = status.unusable;
            cell.steps =
                fewer == study.scale.steps_for.end() ? cell.full_steps : std::min(fewer->second, cell.full_steps);
            for (const int threads : block.threads)
              if (threads == 1 || is_threaded(status)) {
                cell.threads = threads;
                study.cells.push_back(cell);
              }
          }
}

void require_cell_of(const std::string& variant, const Study& study, const JsonPlace& place) {
  known_variant(variant, place);
  if (std::none_of(study.cells.begin(), study.cells.end(), [&](const Cell& cell) { return cell.variant == variant; }))
    place.fail(fmt::format("no cell of the study has the variant \"{}\"", variant));
}

void require_distinct_cells(const JsonPlace& place, const Study& study) {
  std::set<std::string> keys;
  for (const Cell& cell : study.cells)
    if (!keys.insert(cell.key()).second) place.fail(fmt::format("the same cell twice: {}", cell.key()));
}

/// Doubles the first cell of a variant, in each problem of the study: their ratio shows what the measurement can tell
/// apart.
void add_twins(const std::string& variant, Study& study) {
  std::vector<Cell> twins;
  for (const Cell& cell : study.cells) {
    const bool has_one = std::any_of(twins.begin(), twins.end(),
                                     [&](const Cell& twin) { return twin.problem_key() == cell.problem_key(); });
    if (cell.variant != variant || !cell.skipped.empty() || has_one) continue;
    twins.push_back(cell);
    twins.back().is_twin = true;
  }
  study.cells.insert(study.cells.end(), twins.begin(), twins.end());
}

fs::path study_directory() {
  if (const char* directory = std::getenv("DSSBENCH_EXPERIMENTS")) return directory;
  return fs::path(DSS_SOURCE_DIR) / "experiments";
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

} // namespace

std::string Cell::set_text() const {
  std::string text;
  for (const Override& item : set) text += fmt::format("{}{}={}", text.empty() ? "" : " ", item.key, item.value);
  return text;
}

std::string Cell::problem_key() const {
  return fmt::format("{} {} {} {} {} {} steps", scene, set_text(), model, precision, integrator, steps);
}

std::string Cell::key() const {
  return fmt::format("{} {} {} t{} {} {} {} {} steps{}", scene, set_text(), variant, threads, model, precision,
                     integrator, steps, is_twin ? " (A/A)" : "");
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

Study load_study(const std::string& name_or_path, const std::string& scale, int cores) {
  Study study;
  study.path = study_path(name_or_path);
  const nlohmann::json json = parse_json_file(study.path);
  const JsonPlace root(json, study.path);
  root.require_keys({"experiment", "title", "cells", "base", "twin", "paper", "scales"});
  study.name = root["experiment"].text();
  if (study.name.find_first_of("/ ") != std::string::npos) root["experiment"].fail("names files: no slash, no space");
  study.title = root["title"].text();
  study.scale = read_scale(root["scales"], scale);
  const JsonPlace scale_place = root["scales"][scale];
  const Sets scale_sets = scale_place.has("set") ? combinations(scale_place["set"]) : Sets(1);
  for (const JsonPlace& block : root["cells"].items()) add_cells(block, scale_sets, cores, study);
  if (study.cells.empty()) root["cells"].fail("no cell; give at least one scene with a variant");
  require_distinct_cells(root["cells"], study);
  for (const auto& own : study.scale.steps_by_set)
    if (std::none_of(study.cells.begin(), study.cells.end(),
                     [&](const Cell& cell) { return cell.set_text() == own.first; }))
      scale_place["steps_by_set"].fail(fmt::format("no cell has the overrides \"{}\"; the first cell has \"{}\"",
                                                   own.first, study.cells[0].set_text()));
  study.bases = root["base"].texts();
  for (const std::string& base : study.bases) require_cell_of(base, study, root["base"]);
  if (root.has("twin")) {
    require_cell_of(root["twin"].text(), study, root["twin"]);
    add_twins(root["twin"].text(), study);
  }
  if (root.has("paper")) {
    root["paper"].require_keys({"source", "rows"});
    study.paper_source = root["paper"]["source"].text();
    for (const JsonPlace& row : root["paper"]["rows"].items()) {
      row.require_keys({"label", "wall_s", "speedup"});
      study.paper.push_back(
          {row["label"].text(), row["wall_s"].positive(), row.has("speedup") ? row["speedup"].positive() : 0});
    }
  }
  return study;
}

} // namespace dss
