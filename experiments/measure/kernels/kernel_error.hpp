#pragma once
/// Error of a compiled kernel against long double.
#include "kernels/compiled_kernel.hpp"

namespace dss {

/// Largest relative error of one pass over 128 elements (two rows, or two blocks of a case).
/// The error of an element is relative to its largest result. If results cancel, it is relative to
/// 1/16 of its largest operand.
double kernel_error(const CompiledKernel& kernel);

} // namespace dss
