#pragma once
/// The halo of a part on a device: which ranges are transferred, and where the host sees them.
#include "variants/opencl/device_problem.hpp"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace dss::opencl {

/// What neighbours receive from this part, and what they send, lies in rows of the arena. If the
/// device has memory of its own, these rows have an image in the host's pinned memory. Else the
/// arena itself is the image.
template <class T, int W>
class HaloRows {
public:
  explicit HaloRows(DeviceProblem<T, W>& problem) : problem_(problem) {}
  /// Waits for transfers, since after an error they may still use the images.
  ~HaloRows();
  HaloRows(const HaloRows&) = delete;
  HaloRows& operator=(const HaloRows&) = delete;

  /// A range of the arena and its image, contiguous in both.
  struct Range {
    T *from, *to, *image;
  };
  using Ranges = std::vector<Range>;
  struct Row {
    T* numbers;
    std::size_t count;
    auto operator<=>(const Row&) const = default;
  };
  /// Makes images of those rows that have none, with the rows' present numbers. Rows that follow
  /// one another in the arena do so as images too.
  void make_images(std::vector<Row> rows);
  T* image(T* row) const { return problem_.is_shared() ? row : images_.at(row); }
  /// Adds a range, and joins ranges that touch or overlap.
  static void add(Ranges& ranges, Range range);

  /// From now on transfers use a queue of their own, beside that of the problem.
  void go_beside() { own_queue_.emplace(problem_.queue.device()); }
  /// The queue that orders the transfers.
  Queue& queue() { return own_queue_ ? *own_queue_ : problem_.queue; }
  /// Copies ranges from the device to the images.
  /// @return the event at the end; null if nothing is left to wait for
  cl::Event fetch(const Ranges& ranges);
  /// Copies ranges from the images to the device. The images must not change until it is done.
  void bring(const Ranges& ranges);
  /// Copies between the arena's rows and the images, while the host has the arena.
  void fetch_from_arena(const Ranges& ranges) const;
  void bring_to_arena(const Ranges& ranges) const;

  /// Counts of the own queue; zeros if there is none.
  Counts counts() { return own_queue_ ? own_queue_->counts() : Counts{}; }

private:
  std::size_t place(const T* at) const {
    return std::size_t(reinterpret_cast<const std::byte*>(at) - problem_.memory.start());
  }
  DeviceProblem<T, W>& problem_;
  std::optional<Queue> own_queue_;
  std::map<const T*, T*> images_; ///< from a row to its image
  std::vector<Buffer> pinned_;
  std::vector<std::unique_ptr<Mapping>> mappings_;
};

} // namespace dss::opencl
