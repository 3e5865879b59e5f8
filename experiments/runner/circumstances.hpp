#pragma once
/// What the records of a study were made from: raw/NAME.json beside raw/NAME.csv.
#include "experiments/runner/study.hpp"
#include "solver/scene/scene.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// Changes with the scene's file and with the voxels that a file beside it gives.
std::string scene_digest(const Scene& scene);

/// Writes the study's name and scale, the digests of its scenes, and the context as a measured process saw it.
void write_circumstances(const std::string& path, const nlohmann::json& context, const Study& study);

/// Adds the present time to `resumed_utc` of the file: its records were gone on with.
void note_resumption(const std::string& path);

/// Makes room for the records of a study that keeps no cells of several scales in one file: with `resumes` those present must be of the same scale and
/// circumstances; else they are of the same scale and move to PATH.previous, so that a run that is cut off before its first record cannot be gone on with as if they were its own.
/// @throws InputError if they are not
void make_room_for_records(const std::string& raw, const std::string& context, const Study& study, bool resumes);

/// Repetitions of one cell must be of one program, machine and scene.
/// @throws InputError if those of the file are not those of now
void require_same_circumstances(const std::string& path, const Study& study);

} // namespace dss
