#include "experiments/studies/run_study.hpp"
#include "experiments/base/exit_code.hpp"
#include "experiments/base/interrupt.hpp"
#include "experiments/measure/circumstances.hpp"
#include "experiments/measure/study_lock.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/studies/registry.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace dss {
namespace {

std::vector<std::string> keys_of(const StudyKind& kind) {
  std::vector<std::string> keys{kind.key};
  keys.insert(keys.end(), kind.required_keys.begin(), kind.required_keys.end());
  keys.insert(keys.end(), kind.optional_keys.begin(), kind.optional_keys.end());
  return keys;
}

/// The kinds of study that a file contains. A key belongs to the first kind that claims it.
std::vector<const StudyKind*> kinds_of(ObjectNode& root) {
  std::set<std::string> claimed;
  std::vector<const StudyKind*> kinds;
  for (const StudyKind* kind : study_kinds()) {
    if (!root.has(kind->key) || claimed.contains(kind->key)) continue;
    kinds.push_back(kind);
    for (const std::string& key : keys_of(*kind)) claimed.insert(key);
  }
  return kinds;
}

std::vector<std::string> required_keys(ObjectNode& root) {
  std::vector<std::string> keys;
  for (const StudyKind* kind : kinds_of(root))
    keys.insert(keys.end(), kind->required_keys.begin(), kind->required_keys.end());
  return keys;
}

/// The studies of a file, in the order in which they run.
std::vector<std::unique_ptr<Study>> read_studies(const StudyFile& file) {
  ObjectNode root(file.root);
  const std::vector<const StudyKind*> kinds = kinds_of(root);
  if (kinds.empty()) {
    std::vector<std::string> known;
    for (const StudyKind* kind : study_kinds()) known.emplace_back(kind->key);
    root.fail(fmt::format("asks for nothing; give one of {}", listed(known)));
  }
  root.name_or("$schema", "");
  root.allow({"experiment", "title", "scales"});
  for (const StudyKind* kind : kinds) root.allow(keys_of(*kind));
  root.finish();
  std::vector<std::unique_ptr<Study>> studies;
  for (const StudyKind* kind : kinds) studies.push_back(kind->read(file));
  return studies;
}

} // namespace

int run_study(Study& study, const StudyHead& head, const StudyOptions& options) {
  const StudyPaths paths = study_paths(options.directory, head.name);
  if (options.is_dry) {
    fmt::print("{}", study.plan(paths));
    return exit_success;
  }
  make_directories(paths);
  const StudyLock lock(paths.raw);
  if (study.keeps_records())
    say_when_interrupted(
        fmt::format("{} keeps the records that were measured; go on with --resume", paths.raw));
  else
    say_when_interrupted(fmt::format("{} is as it was before", paths.table));
  Progress progress;
  const StudyResult result =
      study.run({options.directory, paths, options.resumes, options.rounds, progress});
  for (const NamedTable& named : result.tables)
    write_csv(study_paths(options.directory, named.name).table, without_empty_columns(named.table));
  fmt::print("{}\n", result.text);
  if (!result.tables.empty())
    fmt::print("Table: {}\n", study_paths(options.directory, result.tables.front().name).table);
  if (study.keeps_records()) fmt::print("Records: {}\n", paths.raw);
  return result.is_fine ? exit_success : exit_check_failed;
}

int run_study_file(const std::string& name_or_path, const StudyOptions& options) {
  const StudyFile file = open_study(name_or_path, options.scale, required_keys);
  const std::vector<std::unique_ptr<Study>> studies = read_studies(file);
  const bool has_rounds =
      std::ranges::any_of(studies, [](const auto& study) { return study->has_rounds(); });
  if (options.rounds > 0 && !has_rounds)
    throw InputError(fmt::format("--rounds: {} is not measured in rounds", file.name));
  int code = exit_success;
  for (const auto& study : studies)
    if (options.rounds == 0 || study->has_rounds())
      code = std::max(code, run_study(*study, {file.name, file.title, options.scale}, options));
  const bool has_records =
      std::ranges::any_of(studies, [](const auto& study) { return study->keeps_records(); });
  if (!options.is_dry && !has_records)
    write_circumstances(study_paths(options.directory, file.name).context, measurement_context(),
                        {file.name, file.title, options.scale, file.path, {}});
  return code;
}

} // namespace dss
