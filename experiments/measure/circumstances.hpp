#pragma once
/// Circumstances of a study's records: program, machine and scenes. They are saved as raw/NAME.json
/// beside raw/NAME.csv.
#include "experiments/measure/cell_study.hpp"
#include "solver/scene/scene.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace dss {

/// The study and the scenes that its records depend on.
struct Circumstances {
  std::string experiment, title, scale, path; ///< path: of the study's JSON
  /// scenes with their overrides
  std::vector<std::pair<std::string, std::vector<Override>>> scenes;
};
/// The circumstances of a study of cells.
Circumstances circumstances_of(const CellStudy& study);

/// Digest (16 hexadecimal digits) of the scene's file and of the voxels, which may come from
/// another file.
std::string scene_digest(const Scene& scene);

/// Everything in a cell's scene that a computed file depends on: "n=10 100 elements,
/// 0123456789abcdef".
std::string scene_key(const Cell& cell, const Scene& scene);

/// Writes the study's name and scale, the digests of its scenes and of the sources that its records
/// depend on, and the context that a measured process reported.
void write_circumstances(const std::string& path, const nlohmann::json& context,
                         const Circumstances& of);

/// Adds the present time to `resumed_utc` of the file: from now on a resumed study adds records.
void note_resumption(const std::string& path);

/// Adds to `effort` of the file how often the study waited and repeated.
void note_patience(const std::string& path, const std::string& report);

/// Prepares the raw file of a study that keeps records of one scale only. With `resumes`, the
/// existing records must have the same scale and circumstances. Otherwise they must have the same
/// scale, and the file is renamed to PATH.previous: a run interrupted before its first record can
/// then not resume from foreign records.
/// @throws InputError if the existing records do not match
void make_room_for_records(const std::string& raw, const std::string& context,
                           const Circumstances& of, bool resumes);

/// Requires that the records in the file come from the present program, machine and scenes.
/// Repetitions of one cell may only be combined if they do.
/// @throws InputError if they differ
void require_same_circumstances(const std::string& path, const Circumstances& of);

} // namespace dss
