#include "variants/isa/cpu_features.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

namespace dss {

static bool cpu_has(std::string_view name) {
  const auto features = checked_cpu_features();
  const auto found = std::ranges::find(features, name, &CpuFeature::name);
  return found != features.end() && found->is_there();
}

std::vector<std::string> cpu_features() {
  std::vector<std::string> names;
  for (const CpuFeature& feature : checked_cpu_features()) names.emplace_back(feature.name);
  return names;
}

std::string missing_feature(std::string_view needs) {
  const char* hidden = std::getenv("DSSBENCH_HIDE_CPU_FEATURES");
  const auto is_hidden = [&](std::string_view f) {
    return hidden != nullptr &&
           fmt::format(",{},", hidden).find(fmt::format(",{},", f)) != std::string::npos;
  };
  while (!needs.empty()) {
    const std::size_t comma = std::min(needs.find(','), needs.size());
    const std::string_view feature = needs.substr(0, comma);
    if (!cpu_has(feature) || is_hidden(feature)) return std::string(feature);
    needs.remove_prefix(std::min(comma + 1, needs.size()));
  }
  return {};
}

} // namespace dss
