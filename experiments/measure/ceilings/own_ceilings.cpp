#include "experiments/measure/ceilings/own_ceilings.hpp"
#include "experiments/base/clock.hpp"

#include <algorithm>
#include <barrier>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

namespace dss {
namespace {

constexpr double least_stream_s = 0.02;
constexpr int timings = 7;

using Work = std::function<void(long passes)>;

double seconds_of(const std::function<void()>& work) {
  const auto start = Clock::now();
  work();
  return seconds_since(start);
}

/// Shortest time [s] of a pass on all threads at once; each thread has its own work.
double best_pass_s(int threads, const std::function<Work()>& make_work) {
  long passes = 1;
  double best = std::numeric_limits<double>::infinity();
  std::barrier together(threads);
  std::vector<Work> works; // made here, where an exception can be thrown
  for (int thread = 0; thread < threads; ++thread) works.push_back(make_work());
  const auto run = [&](std::size_t thread) {
    const Work& work = works[thread];
    const bool is_first = thread == 0;
    if (is_first)
      while (seconds_of([&] { work(passes); }) < least_stream_s) passes *= 2;
    for (int timing = 0; timing < timings; ++timing) {
      together.arrive_and_wait();
      const double time = seconds_of([&] {
        work(passes);
        together.arrive_and_wait(); // wait for all threads: the slowest counts
      });
      if (is_first) best = std::min(best, time / double(passes));
    }
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(run, std::size_t(thread));
  run(0);
  for (std::thread& other : others) other.join();
  return best;
}

/// Assembly of a stream; a turn of the loop moves four vectors, and %rdx counts turns. A triad
/// reads three streams, each a quarter of the memory.
std::string stream_text(const VectorNames& names, const std::string& kind, std::size_t bytes) {
  const std::string move = (names.is_scalar ? "mov" : "vmova") + names.suffix;
  const std::size_t quarter = bytes / 4;
  std::string text = "1:\n";
  for (int r = 0; r < 4; ++r) {
    const int at = r * names.bytes;
    text += fmt::format("{} {}(%rdi), %{}{}\n", move, at, names.reg, r);
    if (kind == "triad") {
      if (names.is_scalar)
        text += fmt::format("mulsd {1}(%rdi), %xmm{0}\naddsd {2}(%rdi), %xmm{0}\n", r,
                            quarter + std::size_t(at), 2 * quarter + std::size_t(at));
      else
        text += fmt::format("{0} {2}(%rdi), %{4}{5}\nvfmadd231pd {3}(%rdi), %{4}{5}, %{4}{1}\n",
                            move, r, quarter + std::size_t(at), 2 * quarter + std::size_t(at),
                            names.reg, r + 4);
    }
    if (kind != "load") text += fmt::format("{} %{}{}, {}(%rsi)\n", move, names.reg, r, at);
  }
  text += fmt::format("add ${0}, %rdi\nadd ${0}, %rsi\ndec %rdx\njnz 1b\n", 4 * names.bytes);
  return names.is_scalar ? text : text + "vzeroupper\n";
}

} // namespace

InstructionMix peak_mix(bool is_scalar) {
  InstructionMix mix;
  if (is_scalar)
    mix.sums = mix.products = peak_instructions / 2;
  else
    mix.fma = peak_instructions;
  return mix;
}

double own_peak_flops(const std::string& isa, const std::string& precision, int threads) {
  const VectorNames names = vector_names(isa, precision);
  const InstructionMix mix = peak_mix(names.is_scalar);
  const double lanes = names.is_scalar ? 1 : double(names.bytes) / (precision == "f64" ? 8 : 4);
  const double pass_s = best_pass_s(threads, [&]() -> Work {
    return [code = std::make_shared<GeneratedMix>(mix, isa, precision)](long passes) {
      code->run(passes);
    };
  });
  return peak_instructions * lanes * (names.is_scalar ? 1 : 2) * threads / pass_s;
}

double own_bandwidth(const std::string& isa, const std::string& benchmark, std::size_t bytes,
                     int threads) {
  const VectorNames names = vector_names(isa, "f64");
  const std::string kind = benchmark.substr(0, benchmark.find('_'));
  const std::size_t unit = 16 * std::size_t(names.bytes); // four vectors in each of four streams
  bytes = std::max(bytes / unit, std::size_t(1)) * unit;
  const std::size_t stream = kind == "load" ? bytes : kind == "copy" ? bytes / 2 : bytes / 4;
  const double pass_s = best_pass_s(threads, [&]() -> Work {
    const std::shared_ptr<std::byte> memory(
        static_cast<std::byte*>(std::aligned_alloc(4096, (bytes + 4095) / 4096 * 4096)),
        [](std::byte* p) { std::free(p); });
    std::fill_n(memory.get(), bytes, std::byte{0});
    const auto loop = std::make_shared<AssembledLoop>(stream_text(names, kind, bytes));
    const long turns = long(stream / (4 * std::size_t(names.bytes)));
    return [=](long passes) {
      for (long pass = 0; pass < passes; ++pass)
        (*loop)(memory.get(), memory.get() + (bytes - stream), turns);
    };
  });
  return double(bytes) * threads / pass_s;
}

} // namespace dss
