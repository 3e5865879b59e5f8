/// Microbenchmarks (Google Benchmark) of every kernel case and of whole steps, in every variant that runs here, from
/// the same modules that the solver uses. `make bench`; filter with --benchmark_filter=avx512.
#include "kernels/stage_row/cost.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/scene/scene.hpp"
#include "variants/loader.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>

namespace dss {
namespace {

/// Operands in L1: 64 elements of at most 32 numbers.
constexpr std::size_t elements = 64;

void run_kernel(benchmark::State& state, const CompiledKernel& kernel) {
  const std::size_t size = kernel.precision == Precision::f64 ? sizeof(double) : sizeof(float);
  const auto allocate = [&](int operands) {
    const std::size_t bytes = std::size_t(operands) * elements * size;
    void* p = std::aligned_alloc(64, bytes);
    for (std::size_t n = 0; n < std::size_t(operands) * elements; ++n) { // ordinary numbers: neither zero nor denormal
      if (kernel.precision == Precision::f64)
        static_cast<double*>(p)[n] = 0.1 + 1e-3 * double(n % 7);
      else
        static_cast<float*>(p)[n] = 0.1f + 1e-3f * float(n % 7);
    }
    return std::unique_ptr<void, decltype(&std::free)>(p, &std::free);
  };
  const auto in = allocate(kernel.inputs), out = allocate(kernel.outputs);
  for (auto _ : state) {
    kernel.run(kernel.index, in.get(), out.get(), elements, elements);
    benchmark::ClobberMemory();
  }
  const double done = double(state.iterations()) * double(elements);
  const double bytes = double(std::size_t(kernel.inputs + kernel.outputs) * size);
  state.counters["flop_per_s"] = benchmark::Counter(done * kernel.flops, benchmark::Counter::kIsRate);
  state.counters["byte_per_s"] = benchmark::Counter(done * bytes, benchmark::Counter::kIsRate);
  state.counters["elements_per_s"] = benchmark::Counter(done, benchmark::Counter::kIsRate);
}

/// Whole RK4 steps of the paper's plate: the fused row kernel in its wavefront.
void run_steps(benchmark::State& state, const Plugin& plugin, Model model, Precision precision, int n) {
  const Scene scene = load_scene("plate_paper", {{"n", std::to_string(n)}});
  const Method& method = *find_method("rk4");
  constexpr long steps = 20;
  const auto run = plugin.create({scene.problem, method, model, precision, scene.problem.dt, 1});
  const std::vector<double> signals = signal_rows(scene.problem, method, scene.problem.dt, 0, steps);
  for (auto _ : state) run->advance(steps, signals);
  const double done = double(state.iterations()) * double(steps) * double(scene.problem.lattice.element_count);
  state.counters["element_steps_per_s"] = benchmark::Counter(done, benchmark::Counter::kIsRate);
  state.counters["flop_per_s"] = benchmark::Counter(done * row_flops(model).rk4_step(), benchmark::Counter::kIsRate);
}

void register_all() {
  for (const VariantStatus& variant : variants()) {
    if (!variant.is_usable()) {
      fmt::print(stderr, "skipped {}: {}\n", variant.name, variant.unusable);
      continue;
    }
    const Plugin& plugin = load_variant(variant.name);
    if (plugin.kernels == nullptr) continue;
    for (const CompiledKernel& kernel : plugin.kernels())
      benchmark::RegisterBenchmark(
          fmt::format("kernel/{}/{}/{}/{}", kernel.name, name(kernel.model), name(kernel.precision), plugin.name)
              .c_str(),
          [&kernel](benchmark::State& state) { run_kernel(state, kernel); });
    for (const Model model : models)
      for (const Precision precision : {Precision::f64, Precision::f32})
        for (const int n : {100, 300})
          benchmark::RegisterBenchmark(
              fmt::format("rk4_step/plate_{}/{}/{}/{}", n, name(model), name(precision), plugin.name).c_str(),
              [&plugin, model, precision, n](benchmark::State& state) {
                run_steps(state, plugin, model, precision, n);
              });
  }
}

} // namespace
} // namespace dss

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  dss::register_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
