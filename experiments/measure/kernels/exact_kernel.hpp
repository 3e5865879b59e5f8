#pragma once
/// Results of a kernel in long double, from the same physics source.
#include "kernels/compiled_kernel.hpp"

#include <vector>

namespace dss {

/// Evaluates a kernel in long double on operand(n, element) of kernel_work.hpp. Operands are first
/// rounded to the kernel's precision, as the kernel receives them.
/// @return result n of element e at index e * outputs + n
/// @throws std::logic_error if there is no such kernel
std::vector<long double> exact_results(const CompiledKernel& kernel, std::size_t elements,
                                       std::size_t row_elements);

} // namespace dss
