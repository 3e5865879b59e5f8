#pragma once
/// What this CPU has of what a variant needs, asked before any of the variant's code runs.
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dss {

struct CpuFeature {
  const char* name;
  bool (*is_there)();
};
/// All features of this architecture that can be checked. Defined in the architecture's folder.
std::span<const CpuFeature> checked_cpu_features();

/// Every feature that a variant may need.
std::vector<std::string> cpu_features();

/// First of the features, comma-separated, that this CPU lacks, or that DSSBENCH_HIDE_CPU_FEATURES
/// hides (to try the refusal where the CPU has everything); empty: it has them all.
std::string missing_feature(std::string_view needs);

} // namespace dss
