#pragma once
/// Pieces of the command line that several commands have.
#include "solver/scene/scene.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// "n=10" -> {"n", "10"}. @throws InputError without a key or a value
std::vector<Override> parse_overrides(const std::vector<std::string>& texts);

/// Writes JSON to a file (by temporary and rename) or, for "-", to standard output.
void write_json(const std::string& target, const nlohmann::ordered_json& json);

} // namespace dss
