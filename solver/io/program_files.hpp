#pragma once
/// Files of the program: scenes, studies, platforms.
#include <filesystem>

namespace dss {

/// Prefix under which this program is installed: PREFIX if the program is in PREFIX/bin and
/// PREFIX/share/dssbench exists. Empty if it runs from a build tree. DSSBENCH_PREFIX overrides it,
/// for a process that is not dssbench but links this library.
std::filesystem::path installed_prefix();

/// Place of a file or folder of the program, such as "experiments/scenes": in PREFIX/share/dssbench
/// of an installed program, otherwise in the source tree.
std::filesystem::path program_file(const std::filesystem::path& path);

} // namespace dss
