#pragma once
/// Source text that CMake put into this program (dss_embed).
#include <string_view>

namespace dss {

/// Text of a file of the source tree. @param path  as from its root: "kernels/algebra/spatial.h"
/// @throws std::out_of_range for one that was not embedded
std::string_view embedded(std::string_view path);

} // namespace dss
