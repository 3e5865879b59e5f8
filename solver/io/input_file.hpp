#pragma once
/// Files that are read whole.
#include <filesystem>
#include <fstream>
#include <string>

namespace dss {

/// Opens a file to read it whole. The stream is not open if there is no regular file (a device may
/// have no end), or if it cannot be read.
/// @param share         memory that its content takes, over its size
/// @param what, advice  as in require_memory
/// @throws InputError if it does not fit into memory
std::ifstream open_whole(const std::filesystem::path& path, double share, const std::string& what,
                         const std::string& advice);

/// The bytes of a file.
/// @param kind  such as "STL file", for errors
/// @throws InputError if it cannot be read, or if it and what is made of it do not fit into memory
std::string bytes_of(const std::string& kind, const std::string& path);

} // namespace dss
