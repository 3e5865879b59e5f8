#pragma once
/// What a kernel computes, in long double, from the same physics.
#include "kernels/compiled_kernel.hpp"

#include <vector>

namespace dss {

/// Results of a kernel on operand(n, element) (kernel_work.hpp), rounded to the kernel's precision as it gets them: result n of element e at
/// [e * outputs + n]. @throws std::logic_error if there is no such kernel
std::vector<long double> exact_results(const CompiledKernel& kernel, std::size_t elements, std::size_t row_elements);

} // namespace dss
