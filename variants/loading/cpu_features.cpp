#include "variants/loading/cpu_features.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

namespace dss {
namespace {

struct Feature {
  const char* name;
  bool (*is_there)();
};

/// __builtin_cpu_supports takes literals only.
#define DSS_FEATURE(name)                                                                          \
  {                                                                                                \
    name, [] { return __builtin_cpu_supports(name) != 0; }                                         \
  }
constexpr Feature features[] = {
    DSS_FEATURE("sse4.2"),     DSS_FEATURE("avx"),        DSS_FEATURE("avx2"),
    DSS_FEATURE("fma"),        DSS_FEATURE("bmi"),        DSS_FEATURE("bmi2"),
    DSS_FEATURE("avx512f"),    DSS_FEATURE("avx512dq"),   DSS_FEATURE("avx512bw"),
    DSS_FEATURE("avx512vl"),   DSS_FEATURE("avx512cd"),   DSS_FEATURE("avx512vbmi"),
    DSS_FEATURE("avx512ifma"), DSS_FEATURE("avx512vnni"),
};
#undef DSS_FEATURE

bool cpu_has(std::string_view name) {
  const auto found = std::find_if(std::begin(features), std::end(features),
                                  [&](const Feature& feature) { return feature.name == name; });
  return found != std::end(features) && found->is_there();
}

} // namespace

std::vector<std::string> cpu_features() {
  std::vector<std::string> names;
  for (const Feature& feature : features) names.emplace_back(feature.name);
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
