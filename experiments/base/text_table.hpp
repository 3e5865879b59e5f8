#pragma once
/// Aligned tables for people.
#include <string>
#include <vector>

namespace dss {

/// Formats a table with columns two spaces apart. A column is right-aligned if all its cells are
/// numbers or empty.
std::string text_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows);

} // namespace dss
