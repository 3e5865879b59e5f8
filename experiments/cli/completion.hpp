#pragma once
/// Completes a command line, from the same description that CLI11 uses to parse it.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dss {

/// Completions of the last of `words`, the words after the program's name. They are commands,
/// options, or names of the kind that the option or the positional argument takes (names.hpp).
/// Empty for files, numbers and free text. Bash passes the sign in --option=value as a separate
/// word "=".
std::vector<std::string> completions(const CLI::App& app, std::vector<std::string> words);

} // namespace dss
