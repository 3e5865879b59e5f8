#pragma once
/// Suggestions for names that do not exist.
#include <string>
#include <vector>

namespace dss {

/// `did you mean "x"?` for the name within a third of its length by edit distance, else `known: a, b, c`.
std::string suggestion(const std::string& unknown, const std::vector<std::string>& known);

/// The known name nearest to `unknown`, or an empty text if none is near.
std::string nearest(const std::string& unknown, const std::vector<std::string>& known);

} // namespace dss
