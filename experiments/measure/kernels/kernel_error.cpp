#include "experiments/measure/kernels/kernel_error.hpp"
#include "experiments/measure/kernels/exact_kernel.hpp"
#include "experiments/measure/kernels/kernel_work.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dss {

double kernel_error(const CompiledKernel& kernel) {
  constexpr std::size_t block_elements = 64;
  const KernelShape shape{2 * block_elements, block_elements};
  KernelWork work(kernel, shape);
  work.pass();
  const std::vector<long double> exact = exact_results(kernel, shape.elements, shape.row_elements);
  double most = 0;
  for (std::size_t e = 0; e < shape.elements; ++e) {
    double scale = 0, difference = 0;
    for (int n = 0; n < kernel.inputs; ++n) scale = std::max(scale, std::abs(operand(n, e)) / 16);
    for (int n = 0; n < kernel.outputs; ++n) {
      const long double right = exact[e * std::size_t(kernel.outputs) + std::size_t(n)];
      scale = std::max(scale, double(std::abs(right)));
      const double error = std::abs(double((long double)(work.result(n, e)) - right));
      if (std::isnan(error)) return error;
      difference = std::max(difference, error);
    }
    most = std::max(most, difference / scale);
  }
  return most;
}

} // namespace dss
