#include "variants/loading/outside.hpp"

#include "solver/error.hpp"
#include "solver/json/object_node.hpp"
#include "solver/json/parse.hpp"
#include "variants/isa/cpu_features.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// Names of variants stand in lists, in keys of cells and before a colon, so few characters are
/// allowed.
bool is_name(const std::string& name) {
  const bool is_sound =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
  return !name.empty() && is_sound && name != "auto";
}

void read_description(const fs::path& path, OutsideVariant& variant) {
  if (!fs::exists(path))
    throw InputError(fmt::format("{}: cannot be read, so nobody knows what CPU its module needs",
                                 path.string()));
  const JsonFile file(path.string(), parse_json_file(path.string()));
  ObjectNode object{Node(file)};
  object.must_have({"variant", "isa", "needs"});
  const Node name = object.require("variant");
  if (!is_name(name.text()))
    name.fail(fmt::format(
        "\"{}\" is no name for a variant; take lower-case letters, digits, - and _", name.text()));
  variant.name = name.text();
  variant.isa = object.require("isa").text();
  std::vector<std::string> needs;
  for (const Node& need : object.require("needs").items())
    needs.push_back(need.known_name("CPU feature", cpu_features()));
  variant.needs = fmt::format("{}", fmt::join(needs, ","));
}

/// Turns a faulty description into an unusable variant: the fault must not stop runs of others.
OutsideVariant described(const fs::path& module) {
  const std::string stem = module.stem().string();
  OutsideVariant variant{is_name(stem) ? stem : module.string(), "", "", module.string(), ""};
  try {
    read_description(fs::path(module).replace_extension(".json"), variant);
  } catch (const InputError& error) {
    variant.unusable = fmt::format(
        R"({}; right is {{"variant": "NAME", "isa": "x86-64-v3", "needs": ["avx2"]}}, as )"
        "dssbench_add_variant writes it",
        error.what());
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
