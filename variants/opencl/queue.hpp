#pragma once
/// Memory, kernels and an in-order queue of one device. Every error is an InputError of one line.
#include "variants/opencl/device.hpp"
#include "variants/opencl/program.hpp"

#include <cstddef>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss::opencl {

/// Memory of a device. Copies of this object share it.
class Buffer {
public:
  Buffer() = default;
  std::size_t bytes() const { return bytes_; }
  const cl::Buffer& handle() const { return handle_; }

private:
  friend class Queue;
  cl::Buffer handle_;
  std::size_t bytes_ = 0;
  std::shared_ptr<void> reservation_;
};

/// A kernel of a built program with its arguments. Each executor has its own, because the arguments
/// belong to the kernel.
class Kernel {
public:
  Kernel() = default;
  const cl::Kernel& handle() const { return handle_; }
  /// Sets all arguments, from the first on: buffers, numbers, cl::Local(bytes).
  /// @throws InputError for a wrong size
  template <class... Arguments>
  Kernel& set(const Arguments&... arguments) {
    cl_uint index = 0;
    (set_one(index++, arguments), ...);
    return *this;
  }
  template <class Argument>
  void set_one(cl_uint index, const Argument& argument) {
    guarded(device_, [&] { handle_.setArg(index, argument); });
  }
  void set_one(cl_uint index, const Buffer& buffer) { set_one(index, buffer.handle()); }

private:
  friend class Queue;
  cl::Kernel handle_;
  std::string device_;
};

/// A range of a buffer that is mapped into the host's memory while this object lives.
class Mapping {
public:
  Mapping(const cl::CommandQueue& queue, const cl::Buffer& buffer, void* data, std::size_t bytes)
      : queue_(queue), buffer_(buffer), data_(data), bytes_(bytes) {}
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  /// Unmaps: the device has the range back before the next command of the queue begins.
  ~Mapping();
  template <class T>
  std::span<T> as() const {
    return {static_cast<T*>(data_), bytes_ / sizeof(T)};
  }

private:
  cl::CommandQueue queue_;
  cl::Buffer buffer_;
  void* data_;
  std::size_t bytes_;
};

/// What a queue has done.
struct Counts {
  double launches = 0;
  double to_device_bytes = 0, from_device_bytes = 0;
  double transfer_s = 0; ///< time in transfers [s]
  Counts& operator+=(const Counts& other);
};

using Events = std::vector<cl::Event>;
/// Time from start to end of a completed command, by the device's clock [s].
double duration_s(const cl::Event& event);

/// Whether the host waits for the end of a transfer. If not, its memory must exist, unchanged,
/// until finish().
enum class Wait { yes, no };

/// Commands to one device, done in order. All sizes and offsets are in bytes.
class Queue {
public:
  explicit Queue(const Device& device);

  const Device& device() const { return device_; }
  const cl::CommandQueue& handle() const { return queue_; }
  /// What was done while counting was on; it is on at first. Waits for transfers.
  const Counts& counts();
  void set_counting(bool is_counting) { is_counting_ = is_counting; }

  /// Allocates device memory.
  /// @throws InputError before anything is allocated, if the device's largest buffer or its free
  ///   memory is too small: how many GiB are needed, and how many there are
  Buffer make_buffer(std::size_t bytes, cl_mem_flags flags = CL_MEM_READ_WRITE,
                     void* host = nullptr) const;
  Kernel make_kernel(const Program& program, const char* name) const;

  /// Writes or reads a range of a buffer.
  /// @return the event at its end; null if there is no data
  cl::Event write(const Buffer& buffer, std::size_t offset, std::span<const std::byte> data,
                  Wait wait = Wait::yes);
  cl::Event read(const Buffer& buffer, std::size_t offset, std::span<std::byte> data,
                 Wait wait = Wait::yes);
  void copy(const Buffer& from, std::size_t from_offset, const Buffer& to, std::size_t to_offset,
            std::size_t bytes);
  /// Sets all bytes of a buffer to zero.
  void clear(const Buffer& buffer);
  /// @param flags  CL_MAP_READ, CL_MAP_WRITE, both, or CL_MAP_WRITE_INVALIDATE_REGION
  Mapping map(const Buffer& buffer, std::size_t offset, std::size_t bytes, cl_map_flags flags);

  /// Enqueues a kernel.
  /// @param after  null, or events of any flushed queue that must come first
  /// @param end    null, or set to the event at its end; with many short launches events cost more
  ///   than the launches
  void launch(const Kernel& kernel, const cl::NDRange& global,
              const cl::NDRange& local = cl::NullRange, const Events* after = nullptr,
              cl::Event* end = nullptr);
  /// Starts what is enqueued, without waiting.
  void flush();
  /// Waits for everything that is enqueued.
  void finish();
  /// Waits for events. Null events count as completed.
  void await(const Events& events) const;

  /// Time of one launch of a kernel that does nothing, and its end: the median of several, measured
  /// once for each device in a process [s].
  double empty_launch_s();

private:
  double measured_launch_s();
  template <class Enqueue>
  cl::Event transfer(std::size_t bytes, Wait wait, double Counts::*counter, Enqueue&& enqueue);
  /// Adds the time of completed transfers, or of all transfers after waiting for them.
  void count_transfers(Wait wait);

  Device device_;
  cl::CommandQueue queue_;
  Counts counts_;
  std::deque<cl::Event> uncounted_; ///< transfers whose time is not in counts_ yet
  bool is_counting_ = true;
};

} // namespace dss::opencl
