#include "variants/opencl/queue.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fmt/format.h>
#include <map>
#include <mutex>

namespace dss::opencl {
namespace {

constexpr double gibibyte = 1024.0 * 1024 * 1024;

/// Bytes that this process has allocated on a device.
std::atomic<std::size_t>& allocated_on(const Device& device) {
  static std::mutex mutex;
  // Never destroyed: buffers may live longer than statics.
  static auto& of_devices = *new std::map<cl_device_id, std::atomic<std::size_t>>;
  const std::lock_guard lock(mutex);
  return of_devices[device.handle()];
}

/// Counts bytes as allocated while it lives.
class Reservation {
public:
  Reservation(std::atomic<std::size_t>& allocated, std::size_t bytes)
      : allocated_(allocated), bytes_(bytes) {
    allocated_ += bytes_;
  }
  Reservation(const Reservation&) = delete;
  Reservation& operator=(const Reservation&) = delete;
  ~Reservation() { allocated_ -= bytes_; }

private:
  std::atomic<std::size_t>& allocated_;
  std::size_t bytes_;
};

void require_memory(const DeviceEntry& device, double bytes, double allocated) {
  const auto refuse = [&](const std::string& what, double there) {
    throw InputError(fmt::format(
        "opencl: device {} ({}): {} {:.3g} GiB, {:.3g} GiB are there; take a smaller scene, "
        "--precision f32, or another --device",
        device.id, device.name, what, bytes / gibibyte, there / gibibyte));
  };
  if (bytes > device.largest_buffer_bytes) refuse("one buffer needs", device.largest_buffer_bytes);
  bytes += allocated;
  if (bytes > device.memory_bytes) refuse("the scene needs at least", device.memory_bytes);
}

} // namespace

Counts& Counts::operator+=(const Counts& other) {
  launches += other.launches;
  to_device_bytes += other.to_device_bytes, from_device_bytes += other.from_device_bytes;
  transfer_s += other.transfer_s;
  return *this;
}

double duration_s(const cl::Event& event) {
  return 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                       event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
}

Mapping::~Mapping() {
  try {
    queue_.enqueueUnmapMemObject(buffer_, data_);
  } catch (const cl::Error&) { // the next command of the queue meets and reports the same error
  }
}

Queue::Queue(const Device& device)
    : device_(device), queue_(guarded(device.entry.name, [&] {
        return cl::CommandQueue(context_of(device), device.handle, cl::QueueProperties::Profiling);
      })) {}

Buffer Queue::make_buffer(std::size_t bytes, cl_mem_flags flags, void* host) const {
  std::atomic<std::size_t>& allocated = allocated_on(device_);
  require_memory(device_.entry, double(bytes), double(allocated.load()));
  return guarded(device_.entry.name, [&] {
    Buffer buffer;
    buffer.handle_ = cl::Buffer(context_of(device_), flags, bytes, host);
    buffer.bytes_ = bytes;
    buffer.reservation_ = std::make_shared<Reservation>(allocated, bytes);
    return buffer;
  });
}

Kernel Queue::make_kernel(const Program& program, const char* name) const {
  return guarded(fmt::format("{} (kernel {})", device_.entry.name, name), [&] {
    Kernel kernel;
    kernel.handle_ = cl::Kernel(program.handle, name);
    kernel.device_ = fmt::format("{} (kernel {})", device_.entry.name, name);
    return kernel;
  });
}

template <class Enqueue>
cl::Event Queue::transfer(std::size_t bytes, Wait wait, double Counts::*counter,
                          Enqueue&& enqueue) {
  cl::Event done;
  guarded(device_.entry.name, [&] { enqueue(wait == Wait::yes ? CL_TRUE : CL_FALSE, &done); });
  if (!is_counting_) return done;
  counts_.*counter += double(bytes);
  uncounted_.push_back(done);
  count_transfers(Wait::no);
  return done;
}

// Uses the device's own times, so that kernels in front of a transfer do not count.
void Queue::count_transfers(Wait wait) {
  guarded(device_.entry.name, [&] {
    for (; !uncounted_.empty(); uncounted_.pop_front()) {
      const cl::Event& first = uncounted_.front();
      if (wait == Wait::yes)
        first.wait();
      else if (first.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() != CL_COMPLETE)
        return;
      counts_.transfer_s += duration_s(first);
    }
  });
}

const Counts& Queue::counts() {
  count_transfers(Wait::yes);
  return counts_;
}

cl::Event Queue::write(const Buffer& buffer, std::size_t offset, std::span<const std::byte> data,
                       Wait wait) {
  if (data.empty()) return {};
  return transfer(data.size(), wait, &Counts::to_device_bytes,
                  [&](cl_bool is_blocking, cl::Event* done) {
                    queue_.enqueueWriteBuffer(buffer.handle(), is_blocking, offset, data.size(),
                                              data.data(), nullptr, done);
                  });
}

cl::Event Queue::read(const Buffer& buffer, std::size_t offset, std::span<std::byte> data,
                      Wait wait) {
  if (data.empty()) return {};
  return transfer(data.size(), wait, &Counts::from_device_bytes,
                  [&](cl_bool is_blocking, cl::Event* done) {
                    queue_.enqueueReadBuffer(buffer.handle(), is_blocking, offset, data.size(),
                                             data.data(), nullptr, done);
                  });
}

void Queue::copy(const Buffer& from, std::size_t from_offset, const Buffer& to,
                 std::size_t to_offset, std::size_t bytes) {
  if (bytes == 0) return;
  guarded(device_.entry.name, [&] {
    queue_.enqueueCopyBuffer(from.handle(), to.handle(), from_offset, to_offset, bytes);
  });
}

void Queue::clear(const Buffer& buffer) {
  guarded(device_.entry.name,
          [&] { queue_.enqueueFillBuffer(buffer.handle(), cl_uchar(0), 0, buffer.bytes()); });
}

Mapping Queue::map(const Buffer& buffer, std::size_t offset, std::size_t bytes,
                   cl_map_flags flags) {
  return guarded(device_.entry.name, [&] {
    void* data = queue_.enqueueMapBuffer(buffer.handle(), CL_TRUE, flags, offset, bytes);
    if (is_counting_ && !device_.is_unified) {
      if ((flags & CL_MAP_READ) != 0) counts_.from_device_bytes += double(bytes);
      if ((flags & (CL_MAP_WRITE | CL_MAP_WRITE_INVALIDATE_REGION)) != 0)
        counts_.to_device_bytes += double(bytes);
    }
    return Mapping(queue_, buffer.handle(), data, bytes);
  });
}

void Queue::launch(const Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
                   const Events* after, cl::Event* end) {
  guarded(kernel.device_, [&] {
    queue_.enqueueNDRangeKernel(kernel.handle(), cl::NullRange, global, local, after, end);
  });
  if (is_counting_) ++counts_.launches;
}

void Queue::flush() {
  guarded(device_.entry.name, [&] { queue_.flush(); });
}

void Queue::finish() {
  guarded(device_.entry.name, [&] { queue_.finish(); });
}

void Queue::await(const Events& events) const {
  guarded(device_.entry.name, [&] {
    for (const cl::Event& event : events)
      if (event() != nullptr) event.wait();
  });
}

double Queue::empty_launch_s() {
  static std::mutex mutex;
  static std::map<cl_device_id, double> known_s;
  const std::lock_guard lock(mutex);
  if (const auto found = known_s.find(device_.handle()); found != known_s.end())
    return found->second;
  return known_s[device_.handle()] = measured_launch_s();
}

double Queue::measured_launch_s() {
  const Kernel nothing =
      make_kernel(build_program(device_, "__kernel void nothing() {}"), "nothing");
  std::array<double, 11> times{};
  const bool was_counting = std::exchange(is_counting_, false);
  launch(nothing, cl::NDRange(1)); // the first launch compiles
  finish();
  for (double& time : times) {
    const auto start = std::chrono::steady_clock::now();
    launch(nothing, cl::NDRange(1));
    finish();
    time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  is_counting_ = was_counting;
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  return times[times.size() / 2];
}

} // namespace dss::opencl
