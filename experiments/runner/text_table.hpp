#pragma once
/// Aligned tables for people.
#include <string>
#include <vector>

namespace dss {

/// Head and rows in columns two spaces apart; columns in which every row is a number or empty are flush right.
std::string text_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

} // namespace dss
