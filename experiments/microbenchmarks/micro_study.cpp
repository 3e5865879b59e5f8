#include "experiments/microbenchmarks/micro_study.hpp"
#include "experiments/microbenchmarks/likwid_markers.hpp"
#include "experiments/microbenchmarks/micro_tables.hpp"
#include "experiments/runner/circumstances.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/experiment.hpp"
#include "experiments/runner/keyed_study.hpp"
#include "experiments/runner/progress.hpp"
#include "experiments/runner/study_sets.hpp"
#include "solver/numerics/denormals.hpp"
#include "variants/loader.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace dss {
namespace {

/// Whole numbers, with "cores" for as many threads as there are.
std::vector<int> thread_counts(const JsonPlace& place) {
  std::vector<int> counts;
  for (const JsonPlace& item : place.items()) {
    const int count = item.value() == "cores" ? usable_cores() : int(item.count(1));
    if (std::ranges::find(counts, count) == counts.end() && count <= usable_cores()) counts.push_back(count);
  }
  return counts;
}

MicroSet read_micro_set(const JsonPlace& place) {
  place.require_keys({"kernels", "models", "precisions", "variants", "levels", "threads", "n"});
  const auto texts = [&](const char* key) {
    return place.has(key) ? place[key].texts() : std::vector<std::string>{"*"};
  };
  MicroSet set{texts("kernels"), texts("models"), texts("precisions"), texts("variants"), texts("levels"), {1}, {}};
  if (place.has("threads")) set.threads = thread_counts(place["threads"]);
  if (place.has("n"))
    for (const JsonPlace& n : place["n"].items()) set.sizes.push_back(int(n.count(2)));
  return set;
}

void read_attribution(const JsonPlace& place, std::vector<AttributionCase>& cases) {
  place.require_keys({"variants", "models", "precisions", "n"});
  for (const std::string& variant : place["variants"].texts())
    for (const JsonPlace& model : place["models"].items())
      for (const JsonPlace& precision : place["precisions"].items())
        for (const JsonPlace& n : place["n"].items())
          cases.push_back({variant, model_in(model), precision_in(precision), int(n.count(2))});
}

/// Every case once, though several sets may ask for it.
std::vector<MicroCase> all_cases(const MicroStudy& study) {
  std::vector<MicroCase> cases;
  std::set<std::string> known;
  for (const MicroSet& set : study.sets)
    for (MicroCase& one : micro_cases(set))
      if (known.insert(one.cell()).second) cases.push_back(std::move(one));
  return cases;
}

/// Measured anew as a whole, resumed or not: its times are compared within rounds.
Table attribution_table(const MicroStudy& study, const std::vector<Ceiling>& ceilings, const std::string& raw_path,
                        Progress& progress) {
  Table table{attribution_columns(), {}};
  RecordFile raw(raw_path, attribution_raw_columns(), false);
  for (const AttributionCase& one : study.attribution) {
    progress.note(
        fmt::format("attribution: {} {} {}, n = {}", one.variant, name(one.model), name(one.precision), one.n));
    try {
      for (Record& row : attribute_step(one, study.attribution_rounds, study.attribution_sample_s, ceilings, raw))
        table.rows.push_back(std::move(row));
    } catch (const InputError& error) {
      table.rows.push_back({{"variant", one.variant},
                            {"model", std::string(name(one.model))},
                            {"precision", std::string(name(one.precision))},
                            {"status", "skipped"},
                            {"reason", error.what()}});
    }
  }
  return table;
}

std::vector<int> ceiling_threads() {
  return usable_cores() > 1 ? std::vector<int>{1, usable_cores()} : std::vector<int>{1};
}

} // namespace

std::optional<MicroStudy> load_micro_study(const std::string& study, const std::string& scale) {
  const auto opened = open_study(study, "microbenchmarks", scale);
  if (!opened) return {};
  opened->scale.require_keys({"repetitions", "sample_s", "attribution_rounds", "attribution_sample_s", "ceilings"});
  opened->work.require_keys({"sets", "attribution"});
  MicroStudy micro;
  micro.name = opened->name, micro.title = opened->title, micro.scale = scale;
  micro.rules = {int(opened->scale["repetitions"].count(1)), opened->scale["sample_s"].positive()};
  micro.attribution_rounds = int(opened->scale["attribution_rounds"].count(1));
  micro.attribution_sample_s = opened->scale["attribution_sample_s"].positive();
  if (opened->scale.has("ceilings")) micro.has_ceilings = opened->scale["ceilings"].flag();
  for (const JsonPlace& set : opened->work["sets"].items()) micro.sets.push_back(read_micro_set(set));
  if (opened->work.has("attribution"))
    for (const JsonPlace& place : opened->work["attribution"].items()) read_attribution(place, micro.attribution);
  return micro;
}

bool run_micro_study(const MicroStudy& study, const std::string& directory, bool resumes) {
  const ExperimentPaths paths = experiment_paths(directory, study.name);
  const auto table_of = [&](const char* name) { return experiment_paths(directory, name).table; };
  std::error_code error;
  for (const std::string& path : {paths.raw, paths.table})
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
  Study circumstances;
  circumstances.name = study.name, circumstances.title = study.title, circumstances.scale.name = study.scale;
  const std::vector<MicroCase> cases = all_cases(study); // wrong names are refused before anything is moved
  make_room_for_records(paths.raw, paths.context, circumstances, resumes);
  flush_denormals();
  Progress progress;
  RecordFile records(paths.raw, micro_columns(), resumes);
  nlohmann::json context = measurement_context();
  const std::string no_counters = why_no_counters();
  context["hardware_counters"] = no_counters.empty() ? "available" : "unavailable: " + no_counters;
  context["likwid_markers"] = why_no_markers().empty() ? "counted" : "unavailable: " + why_no_markers();
  if (records.present().empty())
    write_circumstances(paths.context, context, circumstances);
  else
    note_resumption(paths.context);

  std::vector<Ceiling> ceilings;
  if (std::filesystem::exists(table_of("ceilings")) && (resumes || !study.has_ceilings))
    ceilings = read_ceilings(read_csv(table_of("ceilings")));
  if (ceilings.empty() && study.has_ceilings) {
    ceilings = measure_ceilings(ceiling_threads(), [&](const std::string& line) { progress.note(line); });
    write_csv(table_of("ceilings"), ceiling_table(ceilings));
  }
  run_micro_cases(study.name, cases, study.rules, records,
                  [&](double done, double total, const std::string& what) { progress.show(done, total, what); });
  const Table kernels = kernel_table(read_csv(paths.raw).rows, ceilings);
  write_csv(paths.table, kernels);
  if (!study.attribution.empty())
    write_csv(table_of("attribution"),
              attribution_table(study, ceilings, experiment_paths(directory, "attribution").raw, progress));
  fmt::print("{} ({})\n{}Table: {}\n", study.title, study.name, kernel_text(kernels), paths.table);
  return std::ranges::none_of(kernels.rows, [](const Record& row) { return text_in(row, "status") == "wrong"; });
}

} // namespace dss
