#pragma once
/// Help for a name that does not exist.
#include <string>
#include <vector>

namespace dss {

/// "did you mean NAME? known: A, B, C": the known name that begins so, or that with the smallest edit distance if it is near.
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

} // namespace dss
