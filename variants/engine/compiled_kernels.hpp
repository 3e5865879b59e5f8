#pragma once
#include "kernels/compiled_kernel.hpp"

#include <span>

namespace dss {

/// All kernel cases and fused rows in both precisions, compiled for the module's instruction set.
std::span<const CompiledKernel> compiled_kernels();

} // namespace dss
