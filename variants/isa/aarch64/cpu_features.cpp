#include "variants/isa/aarch64/cpu_features.hpp"
#include "variants/isa/cpu_features.hpp"

#include <asm/hwcap.h>
#include <sys/auxv.h>

namespace dss {

std::span<const CpuFeature> checked_cpu_features() {
#define DSS_PROBE(name, macro, bit) {name, [] { return (::getauxval(AT_HWCAP) & (bit)) != 0; }},
  static constexpr CpuFeature all[] = {DSS_EACH_CPU_FEATURE(DSS_PROBE)};
#undef DSS_PROBE
  return all;
}

} // namespace dss
