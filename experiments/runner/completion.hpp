#pragma once
/// What may come next on a command line, from the description that CLI11 parses it by.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dss {

/// Completions of the last of `words`, those after the program's name: commands, options, or names of the kind that the
/// option or the positional takes (names.hpp). Empty where files, numbers or free text may stand. A word "=" of its own
/// is the sign between an option and its value, since bash takes them apart.
std::vector<std::string> completions(const CLI::App& app, std::vector<std::string> words);

} // namespace dss
