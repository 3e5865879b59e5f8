#include "variants/isa/x86/cpu_features.hpp"
#include "variants/isa/cpu_features.hpp"

namespace dss {

std::span<const CpuFeature> checked_cpu_features() {
#define DSS_PROBE(name, macro) {name, [] { return __builtin_cpu_supports(name) != 0; }},
  static constexpr CpuFeature all[] = {DSS_EACH_CPU_FEATURE(DSS_PROBE)};
#undef DSS_PROBE
  return all;
}

} // namespace dss
