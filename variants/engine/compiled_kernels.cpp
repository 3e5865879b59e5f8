/// Runs the kernel cases and the fused rows with this module's instruction set, for the tests of
/// equal bits and for the microbenchmarks.
#include "variants/engine/compiled_kernels.hpp"

#include "kernels/cases.hpp"
#include "kernels/model.hpp"
#include "kernels/stage_row/row_case.hpp"
#include "variants/engine/kernel_set.hpp"

#include <vector>

namespace dss {
namespace {

template <class T>
DSS_FLATTEN void run_kernel(int kernel, const void* in, void* out, std::size_t elements,
                            std::size_t stride) {
  using R = simd::Pack<T>;
  constexpr int most = 32;
  const KernelCase<R>& c = kernel_cases<R>()[std::size_t(kernel)];
  R operands[most], results[most];
  for (std::size_t e = 0; e < elements; e += std::size_t(simd::lanes<T>)) {
    for (int n = 0; n < c.inputs; ++n)
      operands[n] = simd::load(static_cast<const T*>(in) + std::size_t(n) * stride + e);
    c.evaluate(operands, results);
    for (int n = 0; n < c.outputs; ++n)
      simd::store(static_cast<T*>(out) + std::size_t(n) * stride + e, results[n]);
  }
}

/// @param kernel  four times the index in `models`, plus one for the last stage, plus two for the
///     material law
template <class T>
void run_rows(int kernel, const void* in, void* out, std::size_t elements, std::size_t stride) {
  const Model model = models[std::size_t(kernel / 4)];
  const RowCase row_case{kernel % 2 != 0, kernel % 4 >= 2, int(descriptor(model).fields.size()),
                         simd::lanes<T>};
  const Terms terms = row_case_terms(row_case.is_material);
  const KernelSet<T>& kernels = find_kernels<T>(model, row_shape(model, terms).terms);
  run_row_case(row_case, static_cast<const T*>(in), static_cast<T*>(out), elements, stride,
               [&](const RowTask<T>& task) { kernels.stage(task); });
}

template <class T>
void append(std::vector<CompiledKernel>& list, Precision precision) {
  int index = 0;
  for (const auto& c : kernel_cases<simd::Pack<T>>())
    list.push_back({c.name, c.model, precision, c.inputs, c.outputs, c.flops, simd::lanes<T>,
                    run_kernel<T>, index++});
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (!is_built(models[m])) continue;
    const ModelDescriptor& model = descriptor(models[m]);
    const int fields = int(model.fields.size());
    constexpr const char* names[] = {"stage_row", "stage_row_last", "stage_row_material",
                                     "stage_row_material_last"};
    for (int n = 0; n < 4; ++n) {
      const bool is_last = n % 2 != 0, is_material = n >= 2;
      const RowFlops& flops = is_material ? model.material_flops : model.flops;
      list.push_back({names[n], models[m], precision, RowCase::inputs(is_last) * fields, fields,
                      is_last ? flops.last_stage : flops.stage, simd::lanes<T>, run_rows<T>,
                      int(4 * m) + n, true, is_last, is_material});
    }
  }
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
