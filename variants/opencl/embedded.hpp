#pragma once
/// Source text that CMake puts into this program (dss_embed).
#include <string_view>

namespace dss {

/// @param path  of a file, from the root of the source tree: "kernels/algebra/spatial.h"
/// @return the text of the file
/// @throws std::out_of_range if the file is not embedded
std::string_view embedded(std::string_view path);

} // namespace dss
