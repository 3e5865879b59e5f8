#include "variants/loader.hpp"

#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <mutex>
#include <string_view>

namespace dss {
namespace {

struct Entry {
  const char* name;
  const char* isa;
  const char* needs;   ///< CPU features, comma-separated
  const char* missing; ///< why this build lacks it, or empty
  bool is_by_name;     ///< never the choice of auto; asked itself whether it can run
};
constexpr Entry registry[] = {
#include "variants/registry.inc"
};

/// __builtin_cpu_supports takes literals only; this is every feature that a variant may need.
bool cpu_has(std::string_view feature) {
#define DSS_FEATURE(name)                                                                                              \
  if (feature == name) return __builtin_cpu_supports(name) != 0
  DSS_FEATURE("sse4.2");
  DSS_FEATURE("avx");
  DSS_FEATURE("avx2");
  DSS_FEATURE("fma");
  DSS_FEATURE("bmi");
  DSS_FEATURE("bmi2");
  DSS_FEATURE("avx512f");
  DSS_FEATURE("avx512dq");
  DSS_FEATURE("avx512bw");
  DSS_FEATURE("avx512vl");
  DSS_FEATURE("avx512cd");
  DSS_FEATURE("avx512vbmi");
  DSS_FEATURE("avx512ifma");
  DSS_FEATURE("avx512vnni");
#undef DSS_FEATURE
  return false;
}

/// First feature that this CPU lacks, or that DSSBENCH_HIDE_CPU_FEATURES hides (to try the refusal where the CPU has
/// everything).
std::string missing_feature(std::string_view needs) {
  const char* hidden = std::getenv("DSSBENCH_HIDE_CPU_FEATURES");
  const auto is_hidden = [&](std::string_view f) {
    return hidden != nullptr && fmt::format(",{},", hidden).find(fmt::format(",{},", f)) != std::string::npos;
  };
  while (!needs.empty()) {
    const std::size_t comma = std::min(needs.find(','), needs.size());
    const std::string_view feature = needs.substr(0, comma);
    if (!cpu_has(feature) || is_hidden(feature)) return std::string(feature);
    needs.remove_prefix(std::min(comma + 1, needs.size()));
  }
  return {};
}

/// Beside the program when installed, else in the build tree.
std::filesystem::path module_path(const std::string& name) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string file = name + DSS_MODULE_SUFFIX;
  const auto installed = program.parent_path().parent_path() / "lib/dssbench/variants" / file;
  return std::filesystem::exists(installed, error) ? installed : std::filesystem::path(DSS_MODULE_DIR) / file;
}

const Plugin& open_module(const VariantStatus& variant) {
  const auto path = module_path(variant.name);
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw InputError(fmt::format("variant {}: {}", variant.name, dlerror()));
  const auto entry = reinterpret_cast<PluginEntry>(dlsym(module, plugin_symbol));
  if (entry == nullptr)
    throw InputError(fmt::format("variant {}: {} does not export {}", variant.name, path.string(), plugin_symbol));
  const Plugin* plugin = entry();
  if (plugin->abi != plugin_abi)
    throw InputError(fmt::format("variant {}: {} speaks interface {}, this program {}", variant.name, path.string(),
                                 plugin->abi, plugin_abi));
  if (plugin->name != variant.name)
    throw InputError(fmt::format("variant {}: {} holds variant {}", variant.name, path.string(), plugin->name));
  return *plugin;
}

/// A library that a module needs may be missing, or a device.
std::string why_unusable(const VariantStatus& variant) {
  try {
    const Plugin& plugin = open_module(variant);
    return plugin.why_unusable == nullptr ? "" : plugin.why_unusable();
  } catch (const InputError& error) {
    return error.what();
  }
}

} // namespace

const std::vector<VariantStatus>& variants() {
  static const std::vector<VariantStatus> all = [] {
    std::vector<VariantStatus> list;
    for (const Entry& entry : registry) {
      const std::string missing = missing_feature(entry.needs);
      const std::string cannot = missing.empty() ? entry.missing : fmt::format("this CPU lacks {}", missing);
      list.push_back({entry.name, entry.isa, cannot, entry.is_by_name});
    }
    return list;
  }();
  return all;
}

const std::vector<VariantStatus>& asked_variants() {
  static const std::vector<VariantStatus> all = [] {
    std::vector<VariantStatus> list = variants();
    for (VariantStatus& variant : list)
      if (variant.is_by_name && variant.is_usable()) variant.unusable = why_unusable(variant);
    return list;
  }();
  return all;
}

std::vector<std::string> usable_variants() {
  std::vector<std::string> names;
  for (const VariantStatus& variant : asked_variants())
    if (variant.is_usable()) names.push_back(variant.name);
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

const Plugin& load_variant(const std::string& name) {
  static std::mutex mutex;
  auto& opened = opened_plugins();
  const VariantStatus* found = nullptr;
  std::vector<std::string> names{"auto"};
  for (const VariantStatus& variant : variants()) {
    names.push_back(variant.name);
    if (variant.name == name || (name == "auto" && variant.is_usable() && !variant.is_by_name)) found = &variant;
  }
  if (found == nullptr)
    throw InputError(fmt::format("variant \"{}\" does not exist; {}", name, nearest_name(name, names)));
  if (!found->is_usable())
    throw InputError(fmt::format("variant {} cannot run here: {}; `dssbench list variants` shows those that can", name,
                                 found->unusable));
  const std::lock_guard lock(mutex);
  if (const auto known = opened.find(found->name); known != opened.end()) return *known->second;
  return *opened.emplace(found->name, &open_module(*found)).first->second;
}

} // namespace dss
