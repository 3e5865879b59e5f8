#include "variants/outside.hpp"

#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "variants/cpu_features.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace dss {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> variant_path() {
  const char* text = std::getenv(variant_path_variable);
  std::istringstream parts(text == nullptr ? "" : text);
  std::vector<std::string> directories;
  for (std::string part; std::getline(parts, part, ':');)
    if (!part.empty()) directories.push_back(part);
  return directories;
}

void require_directory(const std::string& directory) {
  std::error_code error;
  if (!fs::is_directory(directory, error))
    throw InputError(fmt::format("--variant-path {}: no such directory; give one that holds modules, NAME.so with "
                                 "NAME.json (also from {})",
                                 directory, variant_path_variable));
}

[[noreturn]] void refuse_description(const fs::path& path, const std::string& why) {
  throw InputError(fmt::format(R"({}: {}; right is {{"variant": "NAME", "isa": "x86-64-v3", "needs": ["avx2"]}}, as )"
                               "dssbench_add_variant writes it",
                               path.string(), why));
}

std::string joined_needs(const nlohmann::json& needs, const fs::path& path) {
  std::vector<std::string> names;
  const std::vector<std::string> known = cpu_features();
  for (const nlohmann::json& need : needs) {
    if (!need.is_string()) refuse_description(path, "\"needs\" is no list of CPU features");
    names.push_back(need.get<std::string>());
    if (std::find(known.begin(), known.end(), names.back()) == known.end())
      throw InputError(fmt::format("{}: needs \"{}\", which is no CPU feature that can be checked; {}", path.string(),
                                   names.back(), nearest_name(names.back(), known)));
  }
  return fmt::format("{}", fmt::join(names, ","));
}

/// Names stand in lists, in keys of cells and before a colon.
void require_name(const std::string& name, const fs::path& path) {
  const bool is_sound = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
  if (name.empty() || !is_sound || name == "auto")
    throw InputError(fmt::format("{}: \"{}\" is no name for a variant; take lower-case letters, digits, - and _",
                                 path.string(), name));
}

OutsideVariant described(const fs::path& module) {
  fs::path description = module;
  description.replace_extension(".json");
  std::ifstream file(description);
  if (!file) refuse_description(description, "cannot be read, so nobody knows what CPU its module needs");
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  const auto has_text = [&](const char* key) { return json.contains(key) && json[key].is_string(); };
  if (!json.is_object() || !has_text("variant") || !has_text("isa"))
    refuse_description(description, "lacks \"variant\" or \"isa\", or is no JSON");
  if (!json.contains("needs") || !json["needs"].is_array())
    refuse_description(description, "\"needs\" is no list of CPU features");
  require_name(json["variant"], description);
  return {json["variant"], json["isa"], joined_needs(json["needs"], description), module.string()};
}

} // namespace

void add_variant_path(const std::vector<std::string>& directories) {
  std::vector<std::string> all = variant_path();
  for (const std::string& directory : directories) {
    require_directory(directory);
    if (directory.find(':') != std::string::npos)
      throw InputError(fmt::format("--variant-path {}: a colon separates directories; give one without", directory));
    const std::string absolute = fs::canonical(directory).string();
    if (std::find(all.begin(), all.end(), absolute) == all.end()) all.push_back(absolute);
  }
  if (!directories.empty()) ::setenv(variant_path_variable, fmt::format("{}", fmt::join(all, ":")).c_str(), 1);
}

std::vector<OutsideVariant> outside_variants() {
  std::vector<OutsideVariant> variants;
  for (const std::string& directory : variant_path()) {
    require_directory(directory);
    std::vector<fs::path> modules;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory))
      if (entry.path().extension() == ".so") modules.push_back(entry.path());
    std::sort(modules.begin(), modules.end());
    for (const fs::path& module : modules) variants.push_back(described(module));
  }
  return variants;
}

} // namespace dss
