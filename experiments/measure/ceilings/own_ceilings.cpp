#include "experiments/measure/ceilings/own_ceilings.hpp"
#include "experiments/base/clock.hpp"

#include <algorithm>
#include <barrier>
#include <cstdlib>
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

} // namespace

InstructionMix peak_mix(bool is_scalar) {
  InstructionMix mix;
  if (is_scalar)
    mix.sums = mix.products = peak_instructions / 2;
  else
    mix.fma = peak_instructions;
  return mix;
}

double own_peak_flops(const InstructionSet& isa, bool is_double, int threads) {
  const InstructionMix mix = peak_mix(isa.is_scalar());
  const double lanes = isa.lanes(is_double ? sizeof(double) : sizeof(float));
  const double pass_s = best_pass_s(threads, [&]() -> Work {
    return [code = std::make_shared<GeneratedMix>(mix, isa, is_double)](long passes) {
      code->run(passes);
    };
  });
  return peak_instructions * lanes * (isa.is_scalar() ? 1 : 2) * threads / pass_s;
}

double own_bandwidth(const InstructionSet& isa, const std::string& benchmark, std::size_t bytes,
                     int threads) {
  const std::size_t pack_bytes = std::size_t(isa.lanes(sizeof(double))) * sizeof(double);
  const std::string kind = benchmark.substr(0, benchmark.find('_'));
  const std::size_t unit = 16 * pack_bytes; // four packs in each of four streams
  bytes = std::max(bytes / unit, std::size_t(1)) * unit;
  const std::size_t stream = kind == "load" ? bytes : kind == "copy" ? bytes / 2 : bytes / 4;
  const double pass_s = best_pass_s(threads, [&]() -> Work {
    const std::shared_ptr<std::byte> memory(
        static_cast<std::byte*>(std::aligned_alloc(4096, (bytes + 4095) / 4096 * 4096)),
        [](std::byte* p) { std::free(p); });
    std::fill_n(memory.get(), bytes, std::byte{0});
    const auto loop = std::make_shared<AssembledLoop>(stream_loop(kind, isa, bytes));
    const long turns = long(stream / (4 * pack_bytes));
    return [=](long passes) {
      for (long pass = 0; pass < passes; ++pass)
        (*loop)(memory.get(), memory.get() + (bytes - stream), turns);
    };
  });
  return double(bytes) * threads / pass_s;
}

} // namespace dss
