#include "variants/opencl/ceilings.hpp"
#include "variants/opencl/embedded.hpp"
#include "variants/opencl/queue.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <limits>

namespace dss::opencl {
namespace {

constexpr int chains = 12;       ///< more than latency times throughput of any known unit
constexpr int least_timings = 5; ///< the best one counts
/// Shortest total of the timings of a kernel; other work on the machine must end within it [s].
constexpr double least_total_s = 0.4;
constexpr double least_timing_s = 5e-3;
constexpr double largest_triad_bytes = double(1u << 30); ///< of its three arrays together [bytes]
constexpr std::size_t group = 256;                       ///< work-items of a group on GPUs

/// Kernels with the work-items that suit the device. A CPU gets one for each compute unit, with
/// vectors and contiguous shares; a GPU gets many.
class Bench {
public:
  Bench(Queue& queue, Precision precision)
      : queue_(queue), precision_(precision),
        program_(build_program(queue.device(),
                               std::string(embedded("variants/opencl/device/ceilings.cl")),
                               options())) {}

  double triad_bytes_per_s() const {
    const DeviceEntry& entry = queue_.device().entry;
    const double bytes =
        std::min({largest_triad_bytes, entry.memory_bytes / 4, 3 * entry.largest_buffer_bytes});
    const std::size_t count = std::size_t(bytes / 3) / real_bytes() / group * group;
    const Buffer a = queue_.make_buffer(count * real_bytes()),
                 b = queue_.make_buffer(count * real_bytes()),
                 c = queue_.make_buffer(count * real_bytes());
    Kernel kernel = queue_.make_kernel(program_, "triad");
    for (const Buffer& buffer : {a, b, c}) { // the kernel touches pages first, where it computes
      kernel.set(buffer, buffer, buffer, cl_ulong(count));
      launch(kernel);
      queue_.clear(buffer);
    }
    kernel.set(a, b, c, cl_ulong(count));
    return 3 * double(count * real_bytes()) / best_s(kernel);
  }

  double flops_per_s() const {
    const Buffer out = queue_.make_buffer(items() * real_bytes());
    Kernel kernel = queue_.make_kernel(program_, "chains");
    int rounds = 1 << 10;
    kernel.set(out, cl_int(rounds));
    time_s(kernel); // the first launch compiles
    while (time_s(kernel) < least_timing_s && rounds < 1 << 28)
      kernel.set(out, cl_int(rounds *= 2));
    return 2.0 * chains * rounds * double(items()) * width() / best_s(kernel);
  }

private:
  bool is_cpu() const { return queue_.device().is_cpu; }
  int width() const { return is_cpu() ? queue_.device().vector_width(precision_) : 1; }
  std::size_t scalar_bytes() const { return precision_ == Precision::f64 ? 8 : 4; }
  std::size_t real_bytes() const { return scalar_bytes() * std::size_t(width()); }
  std::size_t items() const {
    const auto units = std::size_t(queue_.device().compute_units);
    return is_cpu() ? units : units * group * 8;
  }

  std::string options() const {
    const char* scalar = precision_ == Precision::f64 ? "double" : "float";
    return fmt::format("-DSCALAR={} -DREAL={}{} -DCHAINS={} {}", scalar, scalar,
                       width() > 1 ? fmt::format("{}", width()) : "", chains,
                       is_cpu()
                           ? "-DFIRST=(count*get_global_id(0)/get_global_size(0)) "
                             "-DLAST=(count*(get_global_id(0)+1)/get_global_size(0)) -DSTRIDE=1"
                           : "-DFIRST=get_global_id(0) -DLAST=count -DSTRIDE=get_global_size(0)");
  }

  void launch(const Kernel& kernel) const {
    queue_.launch(kernel, cl::NDRange(items()), cl::NDRange(is_cpu() ? 1 : group));
  }

  double time_s(const Kernel& kernel) const {
    queue_.finish();
    const auto start = std::chrono::steady_clock::now();
    launch(kernel);
    queue_.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  double best_s(const Kernel& kernel) const {
    time_s(kernel); // the first launch compiles
    double best = std::numeric_limits<double>::infinity(), total = 0;
    for (int timing = 0; timing < least_timings || total < least_total_s; ++timing) {
      const double time = time_s(kernel);
      best = std::min(best, time);
      total += time;
    }
    return best;
  }

  Queue& queue_;
  Precision precision_;
  Program program_;
};

} // namespace

DeviceCeilings measure_ceilings(const std::string& device) {
  Queue queue(find_device(device, Precision::f32));
  const Bench f32(queue, Precision::f32);
  DeviceCeilings ceilings;
  ceilings.f32_flops_per_s = f32.flops_per_s();
  ceilings.triad_bytes_per_s = f32.triad_bytes_per_s();
  if (queue.device().entry.has_f64)
    ceilings.f64_flops_per_s = Bench(queue, Precision::f64).flops_per_s();
  return ceilings;
}

} // namespace dss::opencl
