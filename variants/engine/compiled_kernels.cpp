/// The kernel cases as this module's instruction set runs them: for the equality tests and the microbenchmarks.
#include "variants/engine/compiled_kernels.hpp"

#include "kernels/cases.hpp"

#include <vector>

namespace dss {
namespace {

template <class T>
DSS_FLATTEN void run_kernel(int kernel, const void* in, void* out, std::size_t elements, std::size_t stride) {
  using R = simd::Pack<T>;
  constexpr int most = 32;
  const KernelCase<R>& c = kernel_cases<R>()[std::size_t(kernel)];
  R operands[most], results[most];
  for (std::size_t e = 0; e < elements; e += std::size_t(simd::lanes<T>)) {
    for (int n = 0; n < c.inputs; ++n)
      operands[n] = simd::load(static_cast<const T*>(in) + std::size_t(n) * stride + e);
    c.evaluate(operands, results);
    for (int n = 0; n < c.outputs; ++n) simd::store(static_cast<T*>(out) + std::size_t(n) * stride + e, results[n]);
  }
}

template <class T>
void append(std::vector<CompiledKernel>& list, Precision precision) {
  int index = 0;
  for (const auto& c : kernel_cases<simd::Pack<T>>())
    list.push_back({c.name, c.model, precision, c.inputs, c.outputs, c.flops, simd::lanes<T>, run_kernel<T>, index++});
}

} // namespace

std::span<const CompiledKernel> compiled_kernels() {
  static const std::vector<CompiledKernel> all = [] {
    std::vector<CompiledKernel> list;
    append<double>(list, Precision::f64);
    append<float>(list, Precision::f32);
    return list;
  }();
  return all;
}

} // namespace dss
