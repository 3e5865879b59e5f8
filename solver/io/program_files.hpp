#pragma once
/// Files that belong to the program: scenes, studies, platforms.
#include <filesystem>

namespace dss {

/// The prefix that this program is installed under, as its own place shows (PREFIX/bin), if PREFIX/share/dssbench is
/// there; else empty: it runs from a build tree.
std::filesystem::path installed_prefix();

/// Where a file or folder of the program is, such as "experiments/scenes": in PREFIX/share/dssbench of an installed
/// program, else in the source tree.
std::filesystem::path program_file(const std::filesystem::path& path);

} // namespace dss
