#include "variants/loading/loader.hpp"

#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/nearest_name.hpp"
#include "variants/isa/cpu_features.hpp"
#include "variants/loading/outside.hpp"

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <mutex>

namespace dss {
namespace {

struct Entry {
  const char* name;
  const char* isa;
  const char* needs;   ///< CPU features, comma-separated
  const char* missing; ///< empty, or why this build lacks it
  bool is_by_name;     ///< auto never chooses it; asked_variants asks it whether it can run
};
constexpr Entry registry[] = {
#include "variants/registry.inc"
};

void require_interface(const Plugin& plugin, const VariantStatus& variant,
                       const std::string& path) {
  const char* remedy = "build it against the headers of this program";
  if (plugin.abi != plugin_abi)
    throw InputError(fmt::format("variant {}: {} speaks interface {}, this program {}; {}",
                                 variant.name, path, plugin.abi, plugin_abi, remedy));
  if (plugin.layout != plugin_layout)
    throw InputError(fmt::format(
        "variant {}: {} was compiled with other headers, or another standard library, than "
        "this program; {}",
        variant.name, path, remedy));
  if (plugin.name == nullptr || plugin.isa == nullptr || plugin.create == nullptr)
    throw InputError(fmt::format(
        "variant {}: {} gives no name, isa or create in its Plugin; see variants/api/api.hpp",
        variant.name, path));
  if (plugin.name != variant.name)
    throw InputError(
        fmt::format("variant {}: {} holds variant {}", variant.name, path, plugin.name));
}

const Plugin& open_module(const VariantStatus& variant) {
  const std::string path = module_path(variant);
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw InputError(fmt::format("variant {}: {}", variant.name, dlerror()));
  const auto entry = reinterpret_cast<PluginEntry>(dlsym(module, plugin_symbol));
  if (entry == nullptr)
    throw InputError(
        fmt::format("variant {}: {} does not export {}", variant.name, path, plugin_symbol));
  const Plugin* plugin = entry();
  if (plugin == nullptr)
    throw InputError(
        fmt::format("variant {}: {} of {} gives no Plugin", variant.name, plugin_symbol, path));
  require_interface(*plugin, variant, path);
  return *plugin;
}

/// Opens the module, since a library that it needs, or a device, may be missing.
/// @return empty if the variant can run here, else the reason
std::string why_unusable(const VariantStatus& variant) {
  try {
    const Plugin& plugin = open_module(variant);
    return plugin.why_unusable == nullptr ? "" : plugin.why_unusable();
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string why_not_here(const std::string& needs, const std::string& missing) {
  const std::string feature = missing_feature(needs);
  return feature.empty() ? missing : fmt::format("this CPU lacks {}", feature);
}

} // namespace

const std::vector<VariantStatus>& variants() {
  static const std::vector<VariantStatus> all = [] {
    std::vector<VariantStatus> list;
    for (const Entry& entry : registry)
      list.push_back(
          {entry.name, entry.isa, why_not_here(entry.needs, entry.missing), entry.is_by_name});
    for (const OutsideVariant& outside : outside_variants()) {
      const auto known = std::ranges::find(list, outside.name, &VariantStatus::name);
      if (known != list.end() && !outside.unusable.empty()) {
        // The name belongs to another variant.
        list.push_back({outside.path, outside.isa, outside.unusable, true, outside.path});
        continue;
      }
      if (known != list.end())
        throw InputError(fmt::format(
            "{}: variant {} exists already, {}; give it another name", outside.path, outside.name,
            known->is_outside() ? "in " + known->path : "in this program"));
      list.push_back({outside.name, outside.isa, why_not_here(outside.needs, outside.unusable),
                      true, outside.path});
    }
    return list;
  }();
  return all;
}

std::vector<VariantStatus> listed_variants() {
  std::vector<VariantStatus> list = variants();
  for (VariantStatus& variant : list)
    if (variant.is_by_name && variant.is_usable() && !variant.is_outside())
      variant.unusable = why_unusable(variant);
  return list;
}

const std::vector<VariantStatus>& asked_variants() {
  static const std::vector<VariantStatus> all = [] {
    std::vector<VariantStatus> list = listed_variants();
    for (VariantStatus& variant : list)
      if (variant.is_outside() && variant.is_usable()) variant.unusable = why_unusable(variant);
    return list;
  }();
  return all;
}

std::string module_path(const VariantStatus& variant) {
  if (variant.is_outside()) return variant.path;
  const std::filesystem::path prefix = installed_prefix();
  const auto directory =
      prefix.empty() ? std::filesystem::path(DSS_MODULE_DIR) : prefix / "lib/dssbench/variants";
  return (directory / (variant.name + DSS_MODULE_SUFFIX)).string();
}

std::vector<std::string> usable_variants() {
  std::vector<std::string> names;
  for (const VariantStatus& variant : asked_variants())
    if (variant.is_usable() && !load_variant(variant.name).is_implicit)
      names.push_back(variant.name);
  return names;
}

static std::map<std::string, const Plugin*>& opened_plugins() {
  static std::map<std::string, const Plugin*> opened;
  return opened;
}

void end_variants(int exit_code, bool is_in_order) {
  for (const auto& [name, plugin] : opened_plugins())
    if (plugin->end != nullptr) plugin->end(exit_code, is_in_order);
}

const char* missing_term(const Plugin& plugin, const Problem& problem) {
  if (problem.has_pressure() && !plugin.has_pressure) return pressure_is_missing;
  if (problem.has_mass_ratios() && !plugin.has_mass_ratios) return mass_ratios_are_missing;
  if (problem.has_rotating_frame() && !plugin.has_rotating_frame) return rotation_is_missing;
  return nullptr;
}

void require_terms(const Plugin& plugin, const Problem& problem) {
  if (const char* const missing = missing_term(plugin, problem))
    throw InputError(fmt::format("{}: variant {} {}; give --variant reference", problem.name,
                                 plugin.name, missing));
}

const Plugin& load_variant(const std::string& name) {
  static std::mutex mutex;
  auto& opened = opened_plugins();
  const VariantStatus* found = nullptr;
  std::vector<std::string> names{"auto"};
  for (const VariantStatus& variant : variants()) {
    names.push_back(variant.name);
    if (variant.name == name || (name == "auto" && variant.is_usable() && !variant.is_by_name))
      found = &variant;
  }
  if (found == nullptr)
    throw InputError(
        fmt::format("variant \"{}\" does not exist; {}", name, nearest_name(name, names)));
  if (!found->is_usable())
    throw InputError(
        fmt::format("variant {} cannot run here: {}; `dssbench list variants` shows those that can",
                    name, found->unusable));
  const std::lock_guard lock(mutex);
  if (const auto known = opened.find(found->name); known != opened.end()) return *known->second;
  return *opened.emplace(found->name, &open_module(*found)).first->second;
}

} // namespace dss
