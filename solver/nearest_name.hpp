#pragma once
/// Suggestions for a name that does not exist.
#include <string>
#include <vector>

namespace dss {

/// Returns "did you mean NAME? known: A, B, C". NAME is the known name that starts with `name`, or
/// the nearest one by edit distance; no suggestion if none is near.
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

} // namespace dss
