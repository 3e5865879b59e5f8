#pragma once
/// Processors that this process may use.
#include <vector>

namespace dss {

/// Numbers of the processors in this process's affinity mask.
std::vector<int> affinity();

/// Number of these processors; 1 if the mask is unknown.
int usable_cores();

} // namespace dss
