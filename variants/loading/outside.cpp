#include "variants/loading/outside.hpp"

#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "variants/loading/cpu_features.hpp"

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

void add_once(std::vector<std::string>& all, const std::string& directory) {
  if (std::find(all.begin(), all.end(), directory) == all.end()) all.push_back(directory);
}

/// The existing directories of the environment variable. Others are skipped: the variable may be
/// older than a directory's removal.
std::vector<std::string> variant_path() {
  const char* text = std::getenv(variant_path_variable);
  std::istringstream parts(text == nullptr ? "" : text);
  std::vector<std::string> directories;
  for (std::string part; std::getline(parts, part, ':');) {
    std::error_code error;
    const std::string absolute = part.empty() ? "" : fs::canonical(part, error).string();
    if (part.empty() || error || !fs::is_directory(absolute, error)) continue;
    add_once(directories, absolute.find(':') == std::string::npos ? absolute : part);
  }
  return directories;
}

std::string given_directory(const std::string& directory) {
  std::error_code error;
  const std::string absolute = fs::canonical(directory, error).string();
  if (error || !fs::is_directory(absolute, error))
    throw InputError(fmt::format(
        "--variant-path {}: no such directory; give one that holds modules, NAME.so with "
        "NAME.json",
        directory));
  if (absolute.find(':') != std::string::npos)
    throw InputError(fmt::format(
        "--variant-path {}: a colon separates directories; give one without", directory));
  return absolute;
}

[[noreturn]] void refuse_description(const fs::path& path, const std::string& why) {
  throw InputError(fmt::format(
      R"({}: {}; right is {{"variant": "NAME", "isa": "x86-64-v3", "needs": ["avx2"]}}, as )"
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
      throw InputError(
          fmt::format("{}: needs \"{}\", which is no CPU feature that can be checked; {}",
                      path.string(), names.back(), nearest_name(names.back(), known)));
  }
  return fmt::format("{}", fmt::join(names, ","));
}

/// Names of variants stand in lists, in keys of cells and before a colon, so few characters are
/// allowed.
bool is_name(const std::string& name) {
  const bool is_sound =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
  return !name.empty() && is_sound && name != "auto";
}

void read_description(OutsideVariant& variant) {
  const fs::path path = fs::path(variant.path).replace_extension(".json");
  std::ifstream file(path);
  if (!file) refuse_description(path, "cannot be read, so nobody knows what CPU its module needs");
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  const auto has_text = [&](const char* key) {
    return json.contains(key) && json[key].is_string();
  };
  if (!json.is_object() || !has_text("variant") || !has_text("isa"))
    refuse_description(path, "lacks \"variant\" or \"isa\", or is no JSON");
  const std::string name = json["variant"];
  if (!is_name(name))
    throw InputError(
        fmt::format("{}: \"{}\" is no name for a variant; take lower-case letters, digits, - and _",
                    path.string(), name));
  variant.name = name;
  variant.isa = json["isa"];
  if (!json.contains("needs") || !json["needs"].is_array())
    refuse_description(path, "\"needs\" is no list of CPU features");
  variant.needs = joined_needs(json["needs"], path);
}

/// Turns a faulty description into an unusable variant: the fault must not stop runs of others.
OutsideVariant described(const fs::path& module) {
  const std::string stem = module.stem().string();
  OutsideVariant variant{is_name(stem) ? stem : module.string(), "", "", module.string(), ""};
  try {
    read_description(variant);
  } catch (const InputError& error) {
    variant.unusable = error.what();
  }
  return variant;
}

} // namespace

void add_variant_path(const std::vector<std::string>& directories) {
  std::vector<std::string> all = variant_path();
  for (const std::string& directory : directories) add_once(all, given_directory(directory));
  if (all.empty())
    ::unsetenv(variant_path_variable);
  else
    ::setenv(variant_path_variable, fmt::format("{}", fmt::join(all, ":")).c_str(), 1);
}

std::vector<OutsideVariant> outside_variants() {
  std::vector<OutsideVariant> variants;
  for (const std::string& directory : variant_path()) {
    std::vector<fs::path> modules;
    std::error_code error; // an unreadable directory or file counts as empty
    for (const fs::directory_entry& entry : fs::directory_iterator(directory, error))
      if (entry.path().extension() == ".so" && entry.is_regular_file(error))
        modules.push_back(entry.path());
    std::sort(modules.begin(), modules.end());
    for (const fs::path& module : modules) variants.push_back(described(module));
  }
  std::stable_partition(variants.begin(), variants.end(),
                        [](const OutsideVariant& variant) { return variant.unusable.empty(); });
  return variants;
}

} // namespace dss
