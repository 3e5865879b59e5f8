#include "experiments/measure/circumstances.hpp"
#include "experiments/base/build_info.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/digest.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/model/file_digest.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

nlohmann::json scene_digests(const Circumstances& of) {
  nlohmann::json digests;
  for (const auto& [scene, set] : of.scenes)
    if (nlohmann::json& digest = digests[fmt::format("{} {}", scene, set_text(set))];
        digest.is_null())
      digest = scene_digest(load_scene(scene, set));
  return digests;
}

/// Digests of what the records depend on besides their scenes: the code that measures, the code of
/// the kind of study, whose folder has the study's JSON, and this file. The report computes the
/// last as well.
nlohmann::json source_digests(const std::string& study_path) {
  const std::map<std::string, std::string>& built = build_info().sources;
  nlohmann::json sources{{"core", built.at("core")}, {"json", text_digest(read_text(study_path))}};
  const std::string kind =
      "studies/" + std::filesystem::path(study_path).parent_path().filename().string();
  if (const auto digest = built.find(kind); digest != built.end()) sources[kind] = digest->second;
  return sources;
}

/// Appends a text to a list in a file of circumstances.
void append(const std::string& path, const char* list, const std::string& text) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_text(path));
  json[list].push_back(text);
  AtomicFile file(path);
  file.write(json.dump(2) + "\n");
  file.commit();
}

} // namespace

std::string scene_digest(const Scene& scene) {
  return text_digest(read_text(scene.path) + file_digest(scene.problem));
}

std::string scene_key(const Cell& cell, const Scene& scene) {
  return fmt::format("{} {} elements, {}", cell.set_text(), scene.problem.lattice.element_count,
                     scene_digest(scene));
}

Circumstances circumstances_of(const CellStudy& study) {
  Circumstances of{study.name, study.title, study.scale.name, study.path, {}};
  for (const Cell& cell : study.cells) of.scenes.emplace_back(cell.scene, cell.set);
  return of;
}

void write_circumstances(const std::string& path, const nlohmann::json& context,
                         const Circumstances& of) {
  nlohmann::ordered_json json;
  json["context"] = context;
  json["experiment"] = of.experiment;
  json["title"] = of.title;
  json["scale"] = of.scale;
  json["scenes"] = scene_digests(of);
  if (!of.path.empty()) json["sources"] = source_digests(of.path);
  AtomicFile file(path);
  file.write(json.dump(2) + "\n");
  file.commit();
}

void note_resumption(const std::string& path) { append(path, "resumed_utc", measurement_time()); }

void note_patience(const std::string& path, const std::string& report) {
  append(path, "effort", report);
}

void make_room_for_records(const std::string& raw, const std::string& context,
                           const Circumstances& of, bool resumes) {
  if (!std::filesystem::exists(raw)) return;
  const nlohmann::json old = std::filesystem::exists(context)
                                 ? nlohmann::json::parse(read_text(context), nullptr, false)
                                 : nlohmann::json();
  const std::string scale = old.is_object() ? old.value("scale", "") : "";
  if (!scale.empty() && scale != of.scale)
    throw InputError(
        fmt::format("{}: holds records of scale \"{}\", this is scale \"{}\"; give another --out",
                    raw, scale, of.scale));
  if (resumes) return require_same_circumstances(context, of);
  std::filesystem::rename(raw, raw + ".previous");
}

void require_same_circumstances(const std::string& path, const Circumstances& of) {
  const nlohmann::json old = nlohmann::json::parse(read_text(path), nullptr, false);
  if (!old.is_object() || !old.contains("context") || !old.contains("scenes"))
    throw InputError(fmt::format(
        "{}: does not say which program made the records; measure without --resume", path));
  const nlohmann::json now = measurement_context();
  for (const char* key : {"git_commit", "git_dirty", "compiler", "cpu_model", "outside_variants"}) {
    const nlohmann::json then = old["context"].value(key, nlohmann::json()),
                         here = now.value(key, nlohmann::json());
    if (then != here)
      throw InputError(
          fmt::format("{}: the records are of {} {}, this is {}; measure without --resume", path,
                      key, then.dump(), here.dump()));
  }
  const nlohmann::json digests = scene_digests(of);
  for (const auto& [scene, digest] : digests.items())
    if (old["scenes"].contains(scene) && old["scenes"][scene] != digest)
      throw InputError(
          fmt::format("{}: scene {} has changed since; measure without --resume", path, scene));
}

} // namespace dss
