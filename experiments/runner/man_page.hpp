#pragma once
/// The manual page, made from the description that CLI11 parses the command line by.
#include <CLI/CLI.hpp>
#include <string>

namespace dss {

/// The page in roff with the macros of man(7), as man(1) reads it.
std::string man_page(const CLI::App& app);

} // namespace dss
