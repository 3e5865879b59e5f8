#pragma once
/// Makes the manual page from the same description that CLI11 uses to parse the command line.
#include <CLI/CLI.hpp>
#include <string>

namespace dss {

/// The page in roff with the macros of man(7), which man(1) shows.
std::string man_page(const CLI::App& app);

} // namespace dss
