#include "kernels/simd/simd.hpp"

namespace dss::simd { // must precede the physics headers, which call the qualified name simd::fma
inline long double fma(long double a, long double b, long double c) { return a * b + c; }
} // namespace dss::simd

#include "experiments/measure/kernels/exact_kernel.hpp"
#include "experiments/measure/kernels/kernel_work.hpp"
#include "kernels/cases.hpp"
#include "kernels/stage_row/row_case.hpp"
#include "kernels/stage_row/stage_row.hpp"

#include <stdexcept>
#include <string_view>

namespace dss {
namespace {

using Exact = long double;

Exact exact_operand(const CompiledKernel& kernel, int n, std::size_t element) {
  const double value = operand(n, element);
  return kernel.precision == Precision::f64 ? Exact(value) : Exact(float(value));
}

std::vector<Exact> exact_row(const CompiledKernel& kernel, std::size_t elements,
                             std::size_t row_elements) {
  const std::size_t fields = std::size_t(kernel.outputs), inputs = std::size_t(kernel.inputs);
  std::vector<Exact> in(elements * inputs + inputs),
      out(elements * fields + row_elements * RowCase::most_carry);
  // rows of packs with one lane: the fields of one element are adjacent
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t n = 0; n < inputs; ++n)
      in[n / fields * elements * fields + e * fields + n % fields] =
          exact_operand(kernel, int(n), e);
  with_physics<Exact>(kernel.model, [&]<class P>() {
    const auto run = [&]<bool is_material>() {
      run_row_case(RowCase{kernel.is_last, is_material, int(fields), 1}, in.data(), out.data(),
                   elements, row_elements, [&](const RowTask<Exact>& task) {
                     const StageRow<P, Exact, row_case_terms(is_material)> row{task};
                     RowUpdate<P, Exact> update(task, row.update_scales());
                     row.run(update);
                   });
    };
    kernel.is_material ? run.template operator()<true>() : run.template operator()<false>();
  });
  out.resize(elements * fields);
  return out;
}

} // namespace

std::vector<long double> exact_results(const CompiledKernel& kernel, std::size_t elements,
                                       std::size_t row_elements) {
  if (kernel.is_row) return exact_row(kernel, elements, row_elements);
  for (const auto& c : kernel_cases<Exact>()) {
    if (c.name != std::string_view(kernel.name) || c.model != kernel.model) continue;
    std::vector<Exact> results, in(std::size_t(c.inputs)), out(std::size_t(c.outputs));
    for (std::size_t e = 0; e < elements; ++e) {
      for (int n = 0; n < c.inputs; ++n) in[std::size_t(n)] = exact_operand(kernel, n, e);
      c.evaluate(in.data(), out.data());
      results.insert(results.end(), out.begin(), out.end());
    }
    return results;
  }
  throw std::logic_error("exact_kernel.cpp: this kernel is not in the table of cases");
}

} // namespace dss
