#include "experiments/measure/study_file.hpp"
#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/json/parse.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

namespace fs = std::filesystem;

fs::path study_directory() {
  if (const char* directory = std::getenv("DSSBENCH_EXPERIMENTS")) return directory;
  return program_file("experiments/studies");
}

/// Lists *.json in a folder and in its direct subfolders, without schemas.
std::vector<fs::path> study_files(const fs::path& directory) {
  std::vector<fs::path> files;
  const auto add = [&](const fs::path& path) {
    if (path.extension() == ".json" && path.stem().extension() != ".schema") files.push_back(path);
  };
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    add(entry.path());
    if (!entry.is_directory()) continue;
    for (const auto& inner : fs::directory_iterator(entry.path(), error)) add(inner.path());
  }
  return files;
}

Node scale_of(ObjectNode& root, const std::string& name) {
  ObjectNode scales(root.require("scales"));
  if (const auto scale = scales.find(name)) return *scale;
  std::vector<std::string> known;
  for (const auto& scale : scales.members()) known.push_back(scale.first);
  throw InputError(fmt::format("--scale {}: unknown scale; {}", name, nearest_name(name, known)));
}

} // namespace

std::vector<StudyListing> list_studies() {
  std::vector<StudyListing> listings;
  for (const fs::path& path : study_files(study_directory())) {
    const JsonFile file(path.string(), parse_json_file(path.string()));
    listings.push_back(
        {path.stem().string(), ObjectNode(Node(file)).name_or("title", ""), path.string()});
  }
  std::ranges::sort(listings, {}, &StudyListing::name);
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
  throw InputError(
      fmt::format("{}: no such experiment; {}", name_or_path, nearest_name(name_or_path, names)));
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

StudyFile open_study(const std::string& study, const std::string& scale,
                     const FurtherKeys& further_keys) {
  const std::string path = study_path(study);
  const auto json = std::make_shared<const JsonFile>(path, parse_json_file(path));
  ObjectNode root{Node(*json)};
  std::vector<std::string> keys{"experiment", "title"};
  if (further_keys) std::ranges::copy(further_keys(root), std::back_inserter(keys));
  keys.emplace_back("scales");
  root.must_have(keys);
  const std::string name = root.require("experiment").name();
  if (name.find_first_of("/ ") != std::string::npos)
    root.require("experiment").fail("names files: no slash, no space");
  return {
      json, path, name, root.require("title").name(), scale, root.node(), scale_of(root, scale)};
}

} // namespace dss
