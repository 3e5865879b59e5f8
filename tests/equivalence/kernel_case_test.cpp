/// The kernel cases as C++. Declared costs must equal counted ones. Every compiled module is
/// compared with long double and with the other modules.
#include "kernels/simd/simd.hpp"

#include <cmath>

namespace dss {

/// A number that counts its operations.
struct Counted {
  double value = 0;
  static inline int flops = 0;
  Counted() = default;
  Counted(double v) : value(v) {}
  friend Counted operator+(Counted a, Counted b) { return ++flops, Counted(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return ++flops, Counted(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return ++flops, Counted(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return ++flops, Counted(a.value / b.value); }
  friend Counted operator-(Counted a) { return Counted(-a.value); }
};
namespace simd { // must come before the physics, which calls simd::fma by its qualified name
inline Counted fma(Counted a, Counted b, Counted c) {
  return Counted::flops += 2, Counted(a.value * b.value + c.value);
}
inline long double fma(long double a, long double b, long double c) { return a * b + c; }
} // namespace simd
} // namespace dss

#include "kernels/cases.hpp"
#include "kernels/stage_row/row_case.hpp"
#include "kernels/stage_row/stage_row.hpp"
#include "tests/equivalence/kernel_operands.hpp"
#include "variants/loading/loader.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

TEST(KernelCases, declare_the_flops_that_they_make) {
  for (const auto& c : kernel_cases<Counted>()) {
    Counted in[32], out[32];
    for (Counted& x : in) x = Counted(0.1);
    Counted::flops = 0;
    c.evaluate(in, out);
    EXPECT_EQ(c.flops, Counted::flops) << c.name << ' ' << name(c.model);
  }
}

/// Flops of one stage of the fused row kernel, for an element of a plate's interior. The kernel
/// runs on counting numbers.
template <class P, bool is_material>
int stage_flops(row_action action) {
  constexpr Terms terms = row_case_terms(is_material);
  Counted rows[4][3 * P::fields], carry[2][16];
  for (auto& row : rows)
    for (Counted& x : row) x = Counted(0.01);
  const PackMasks interior{1, 1, 0, 1, 0}, masks[] = {interior, interior};
  BodyConstants<Counted> body{};
  const LinkLanes<Counted> links[3] = {};
  const Counted signals[3];
  RowTask<Counted> task;
  task.masks = masks, task.body = &body, task.links = links, task.signals = signals;
  task.in = rows[0], task.upper_y = rows[1], task.base = rows[2], task.out = rows[3];
  task.carry_y = carry[0], task.from_y = carry[1];
  for (auto& increment : task.increment) increment = rows[1];
  task.action = action, task.is_last = action == combined_stage, task.stride = P::fields;
  const auto count = [&](int packs) {
    task.packs = packs, task.ahead = task.in + packs * task.stride;
    Counted::flops = 0;
    const StageRow<P, Counted, terms> row{task};
    RowUpdate<P, Counted> update(task, row.update_scales());
    row.run(update);
    return Counted::flops;
  };
  return count(2) - count(1); // of one element, without the start of the row
}

TEST(StageRow, makes_the_flops_that_its_readme_declares) {
  for (const Model model : models)
    with_physics<Counted>(model, [&]<class P>() {
      const ModelDescriptor& declared = descriptor(model);
      const auto expect = [&](int counted, int stated) {
        EXPECT_EQ(counted, stated) << name(model);
      };
      expect(stage_flops<P, false>(plain_stage), declared.flops.stage);
      expect(stage_flops<P, false>(combined_stage), declared.flops.last_stage);
      expect(stage_flops<P, true>(plain_stage), declared.material_flops.stage);
      expect(stage_flops<P, true>(combined_stage), declared.material_flops.last_stage);
    });
}

std::vector<const Plugin*> plugins_with_kernels() {
  std::vector<const Plugin*> list;
  for (const VariantStatus& variant : variants())
    if (variant.is_usable() && load_variant(variant.name).kernels != nullptr)
      list.push_back(&load_variant(variant.name));
  return list;
}

template <class T>
void expect_near_long_double(const Plugin& plugin, const CompiledKernel& kernel, double tolerance) {
  const Operands<T> operands(kernel.inputs, kernel.outputs);
  const std::vector<T> results = operands.run(kernel);
  for (const auto& c : kernel_cases<long double>()) {
    if (c.name != std::string_view(kernel.name) || c.model != kernel.model) continue;
    for (std::size_t e = 0; e < Operands<T>::elements; ++e) {
      long double in[32], out[32];
      for (int n = 0; n < c.inputs; ++n) in[n] = operands.input(n, e);
      c.evaluate(in, out);
      long double scale = 0; // a result that cancels is as exact as its operands
      for (int n = 0; n < c.inputs; ++n) scale = std::max(scale, std::abs(in[n]) / 16);
      for (int n = 0; n < c.outputs; ++n) scale = std::max(scale, std::abs(out[n]));
      for (int n = 0; n < c.outputs; ++n)
        ASSERT_NEAR(double(results[std::size_t(n) * Operands<T>::elements + e] - out[n]), 0,
                    tolerance * double(scale))
            << plugin.name << ' ' << kernel.name << ' ' << name(kernel.model) << " output " << n
            << " of element " << e;
    }
  }
}

TEST(CompiledKernels, agree_with_long_double) {
  for (const Plugin* plugin : plugins_with_kernels())
    for (const CompiledKernel& kernel : plugin->kernels())
      if (kernel.is_row)
        continue; // tests/runner checks these, as microbenchmarks do
      else if (kernel.precision == Precision::f64)
        expect_near_long_double<double>(*plugin, kernel, 1e-14);
      else
        expect_near_long_double<float>(*plugin, kernel, 5e-6);
}

template <class T>
std::size_t differing(const CompiledKernel& a, const CompiledKernel& b) {
  const Operands<T> operands(a.inputs, a.outputs);
  return count_differing(operands.run(a), operands.run(b));
}

TEST(CompiledKernels, are_bitwise_equal_over_the_variants_with_fma) {
  const Plugin* first = nullptr;
  int compared = 0;
  for (const Plugin* plugin : plugins_with_kernels()) {
    if (!plugin->has_fma) continue;
    if (first == nullptr) first = plugin;
    for (std::size_t k = 0; k < plugin->kernels().size(); ++k) {
      const CompiledKernel &a = first->kernels()[k], &b = plugin->kernels()[k];
      if (a.is_row) continue; // other lanes give other places
      EXPECT_EQ(a.precision == Precision::f64 ? differing<double>(a, b) : differing<float>(a, b),
                0u)
          << a.name << ' ' << name(a.model) << ' ' << name(a.precision) << ": " << first->name
          << " and " << plugin->name;
    }
    ++compared;
  }
  if (compared < 2) GTEST_SKIP() << "this CPU runs " << compared << " variant(s) with FMA";
}

} // namespace
} // namespace dss::test
