#pragma once
/// Parts of the command line that several commands share.
#include "solver/io/file_set.hpp"
#include "solver/scene/scene.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// "n=10" -> {"n", "10"}. @throws InputError if the key or the value is missing
std::vector<Override> parse_overrides(const std::vector<std::string>& texts);

/// The words after the first "--" of the command line of a command that takes other commands.
/// CommandLine::parse sets them; CLI11 does not see them.
std::vector<std::string>& words_after_mark();

/// Writes JSON to a file (a temporary file that is renamed), or to standard output for "-".
void write_json(const std::string& target, const nlohmann::ordered_json& json);
/// Adds JSON to the files of a run, unless the target is empty, and commits them. Standard output
/// has it after them.
void write_json(FileSet& outputs, const std::string& target, const nlohmann::ordered_json& json);

} // namespace dss
