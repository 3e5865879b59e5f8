#include "experiments/cli/command_files.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fnmatch.h>

namespace fs = std::filesystem;

namespace dss {
namespace {

bool is_named(const std::string& path) { return !path.empty() && path != "-"; }

/// A device or a pipe, which keeps nothing that a second output could replace.
bool is_stream(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// The place of a file that may not exist yet, without links and dots.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : place;
}

/// A text as a pattern that matches itself alone.
std::string escaped(const std::string& text) {
  std::string pattern;
  for (const char c : text) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

/// Adds the files that a scene names, of {"voxels": {"file": ...}}, "stl" and "series", at
/// any depth.
void add_named_files(const nlohmann::json& value, const fs::path& folder,
                     std::vector<std::string>& files) {
  if (!value.is_structured()) return;
  for (const char* key : {"voxels", "stl", "series"}) {
    if (!value.is_object() || !value.contains(key)) continue;
    const nlohmann::json& named = value[key];
    if (named.is_object() && named.contains("file") && named["file"].is_string())
      files.push_back((folder / named["file"].get<std::string>()).string());
  }
  for (const nlohmann::json& inner : value) add_named_files(inner, folder, files);
}

/// None of a scene that cannot be read: the command will say what is wrong with it. A pipe can be
/// read only once.
std::vector<std::string> named_files(const std::string& scene,
                                     const std::vector<Override>& overrides) {
  std::vector<std::string> files;
  if (is_stream(scene)) return files;
  try {
    add_named_files(read_scene_text(scene, overrides).root, fs::path(scene).parent_path(), files);
  } catch (const InputError&) {
  }
  return files;
}

} // namespace

void CommandFiles::read_scene(const std::string& scene, const std::vector<Override>& overrides) {
  const std::string path = scene_path(scene);
  read("SCENE", path);
  for (const std::string& file : named_files(path, overrides)) read("SCENE", file);
}

void CommandFiles::read(const std::string& option, const std::string& path) {
  if (is_named(path)) entries_.push_back({option, path, false, "", ""});
}

void CommandFiles::write(const std::string& option, const std::string& path) {
  if (is_named(path) && !is_stream(path)) entries_.push_back({option, path, true, "", ""});
}

void CommandFiles::write_family(const std::string& option, const std::string& path,
                                const std::string& joint, const std::string& any,
                                const std::string& extension) {
  const std::string stem = fs::path(path).stem().string();
  entries_.push_back({option, path, true, escaped(stem + joint) + any + escaped(extension),
                      stem + joint + "0000" + extension});
}

void CommandFiles::write_series(const std::string& option, const std::string& path) {
  if (!is_named(path)) return;
  if (path.ends_with(".vtkhdf")) return write(option, path); // all in one file
  write_family(option, path, "_", "[0-9]*", ".vtu");
  entries_.push_back({option, fs::path(path).replace_extension(".pvd").string(), true, "", ""});
}

void CommandFiles::write_members(const std::string& option, const std::string& path) {
  if (is_named(path)) write_family(option, path, "-", "*", fs::path(path).extension().string());
}

bool CommandFiles::is_in_family(const Entry& one, const Entry& family) {
  if (family.pattern.empty()) return false;
  const fs::path path = one.path;
  const std::string name = one.pattern.empty() ? path.filename().string() : one.example;
  return place_of(path).parent_path() == place_of(family.path).parent_path() &&
         ::fnmatch(family.pattern.c_str(), name.c_str(), 0) == 0;
}

bool CommandFiles::are_one_file(const Entry& one, const Entry& other) {
  // Which members or frames there will be is not known here, so that a family meets outputs alone.
  if (one.is_written && other.is_written && (is_in_family(one, other) || is_in_family(other, one)))
    return true;
  if (!one.pattern.empty() || !other.pattern.empty()) return false;
  std::error_code error; // hard links are found where both files exist
  return place_of(one.path) == place_of(other.path) || fs::equivalent(one.path, other.path, error);
}

void CommandFiles::require_distinct() const {
  for (std::size_t k = 0; k < entries_.size(); ++k)
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      const Entry &before = entries_[earlier], &here = entries_[k];
      if ((!before.is_written && !here.is_written) || !are_one_file(before, here)) continue;
      const Entry &output = here.is_written ? here : before,
                  &other = here.is_written ? before : here;
      const bool are_many = !output.pattern.empty() || !other.pattern.empty();
      throw InputError(fmt::format("{} {}: {} {} {}; give another", output.option, output.path,
                                   other.option, other.is_written ? "writes" : "reads",
                                   are_many ? "one of these files, " + other.path : "this file"));
    }
}

void require_sound_output(CommandFiles inputs, const std::string& json) {
  inputs.write("--json", json);
  inputs.require_distinct();
  if (is_named(json)) require_writable(json);
}

void require_sound_output(const std::string& scene, const std::vector<Override>& overrides,
                          const std::string& json) {
  CommandFiles inputs;
  inputs.read_scene(scene, overrides);
  require_sound_output(std::move(inputs), json);
}

} // namespace dss
