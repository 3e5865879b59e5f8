#pragma once
/// Parses JSON files. Errors name the file, and the line and the column or the JSON pointer.
#include <nlohmann/json.hpp>

#include <set>
#include <string>

namespace dss {

/// Parses a JSON file.
/// @param left_out  keys, at any depth, whose values are not kept
/// @throws InputError if the file cannot be read, is empty, is not JSON, or has a key twice in one
///     object
nlohmann::json parse_json_file(const std::string& path, const std::set<std::string>& left_out = {});

} // namespace dss
