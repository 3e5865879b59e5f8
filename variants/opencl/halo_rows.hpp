#pragma once
/// The halo of a part on a device: what is transferred with it, and where the host sees it.
#include "variants/opencl/device_problem.hpp"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace dss::opencl {

/// What neighbours are sent lies in rows of the arena, and so does what they send. Where the device has memory of its own, these rows have
/// an image in pinned memory of the host. Elsewhere the arena itself is the image.
template <class T, int W>
class HaloRows {
public:
  explicit HaloRows(DeviceProblem<T, W>& problem) : problem_(problem) {}
  /// Waits for transfers, which may still use the images after an error.
  ~HaloRows();
  HaloRows(const HaloRows&) = delete;
  HaloRows& operator=(const HaloRows&) = delete;

  /// Numbers that lie together in the arena and in the images.
  struct Range {
    T *from, *to, *image;
  };
  using Ranges = std::vector<Range>;
  struct Row {
    T* numbers;
    std::size_t count;
    auto operator<=>(const Row&) const = default;
  };
  /// Makes images of those rows of the arena that have none, as the rows are now. Those that follow one another in the arena do so as images.
  void make_images(std::vector<Row> rows);
  T* image(T* row) const { return problem_.is_shared() ? row : images_.at(row); }
  /// Ranges that touch or overlap become one.
  static void add(Ranges& ranges, Range range);

  /// From now on by a queue of its own, beside that of the problem.
  void go_beside() { own_queue_.emplace(problem_.queue.device()); }
  /// Transfers are done in its order.
  Queue& queue() { return own_queue_ ? *own_queue_ : problem_.queue; }
  /// From the device to the images. @return comes when it is done; none if it is
  cl::Event fetch(const Ranges& ranges);
  /// From the images, which must not change until it is done, to the device.
  void bring(const Ranges& ranges);
  /// While the host has the arena: between its rows and the images.
  void fetch_from_arena(const Ranges& ranges) const;
  void bring_to_arena(const Ranges& ranges) const;

  /// Of the own queue.
  Counts counts() { return own_queue_ ? own_queue_->counts() : Counts{}; }

private:
  std::size_t place(const T* at) const {
    return std::size_t(reinterpret_cast<const std::byte*>(at) - problem_.memory.start());
  }
  DeviceProblem<T, W>& problem_;
  std::optional<Queue> own_queue_;
  std::map<const T*, T*> images_; ///< by row
  std::vector<Buffer> pinned_;
  std::vector<std::unique_ptr<Mapping>> mappings_;
};

} // namespace dss::opencl
