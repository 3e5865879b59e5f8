#pragma once
/// A problem on a device: rows of packs in an arena, tables of the tasks on them, and the program
/// that does the tasks.
#include "variants/engine/packed_rows.hpp"
#include "variants/engine/staged.hpp"
#include "variants/opencl/arena.hpp"
#include "variants/opencl/queue.hpp"
#include "variants/opencl/source.hpp"

#include <climits>
#include <memory>
#include <span>

namespace dss::opencl {

using uint = unsigned;
using ushort = unsigned short;

/// The tables of device/tables.h.
template <class T>
struct Tables {
#define NUMBER T
#include "variants/opencl/device/tables.h"
#undef NUMBER
};

/// The action that computes the same links as a prime_* action, or only their strains.
constexpr row_action prime_of(row_action links, bool is_pressure) {
  if (!is_pressure) return links;
  return links == prime_y ? prime_strain_y : links == prime_z ? prime_strain_z : prime_strain_upper;
}

/// Where rows are computed. A GPU gets a work-item for each element, a CPU one for each band of
/// rows.
struct Layout {
  bool has_items = false;
  int lanes = 1;
  int bands = 1; ///< of a CPU, at most: there may be fewer rows
};
/// For a device.
Layout layout_on(const Device& device, Precision precision, int threads);

/// A problem on a device, in packs of W lanes and numbers of type T.
template <class T, int W>
class DeviceProblem {
public:
  using Row = typename Tables<T>::row_stage;
  DeviceProblem(const Problem& problem, Model model, const Part* part, const Device& device,
                const Layout& layout);
  /// Waits for the device, which may still use the arena after an error.
  ~DeviceProblem();
  DeviceProblem(const DeviceProblem&) = delete;
  DeviceProblem& operator=(const DeviceProblem&) = delete;

  Arena memory; ///< of all buffers that rows and tasks refer to
  PackedRows<T, W> packed;
  const Layout layout;
  mutable Queue queue;

  /// Offset of an address in the arena [numbers of T]; -1 for null.
  long offset(const T* at) const {
    return at == nullptr ? -1 : at - reinterpret_cast<const T*>(memory.start());
  }
  /// Adds a row task to the table of row stages.
  /// @param row        number of the row
  /// @param action     what to do with it
  /// @param fields     numbers that a pack holds for each element
  /// @param published  null, or where the new state is also stored
  /// @param sweep      of a pass
  /// @return its place in the table
  int add(const RowTask<T>& task, int row, row_action action, int fields,
          const T* published = nullptr, int sweep = 0);
  int next_place() const { return int(rows_.size()); }
  /// Gives the program the kernel run_tiles in place of run_rows.
  void set_stage_tile(const StageTile& tile) { tile_ = tile; }
  const StageTile& stage_tile() const { return tile_; }
  /// Call it when the arena and the tables are complete. Builds the program and gives the device
  /// its memory.
  void finish();
  /// A kernel with the tables as its first arguments.
  Kernel kernel(const char* name) const;
  static constexpr cl_uint table_arguments = 13,
                           step_argument = 12; ///< the last: see tables_of_device.h

  /// Work-items that compute one band.
  std::size_t group_size() const { return group_size_; }
  /// Launches a kernel over bands, in a queue of the device and after some events.
  /// @return the event at its end
  cl::Event launch(Queue& by, const Kernel& kernel, int bands, const Events& after = {});
  /// Launches a kernel whose work-items need no others, in the problem's queue. A GPU gets a
  /// work-item for each element across.
  void launch_rows(const Kernel& kernel, int bands);
  /// Launches run_tiles over all elements.
  void launch_tiles(const Kernel& kernel);
  /// to_host() lets the host use the arena until to_device(). If the memory is not shared, both
  /// copy [from, to) of these ranges.
  struct Range {
    const T *from, *to;
  };
  bool is_shared() const { return is_shared_; }
  void to_host(std::span<const Range> ranges);
  void to_device(std::span<const Range> ranges);
  const opencl::Buffer& arena() const { return arena_; }

  /// Sets the signals of some stages, each followed by a constant 1 (StepSignals).
  void set_signals(std::span<const double> rows, std::size_t width);
  const opencl::Buffer& signals() const { return signals_; }
  /// Prepares the extra links. evaluate_extra_links() then adds their forces for the rows whose
  /// offsets `row_starts` gives.
  void add_extra_links(const Problem& problem, int fields);
  bool has_extra_links() const { return !extra_.empty(); }
  void evaluate_extra_links(const opencl::Buffer& row_starts);
  template <class Item>
  opencl::Buffer table(const std::vector<Item>& items) const;

  double build_s() const { return build_s_; }
  bool is_cached() const { return is_cached_; }
  /// Memory of the arena and of the table of row stages [bytes].
  std::size_t bytes() const { return memory.bytes() + rows_.size() * sizeof(Row); }

private:
  int shape_of(const Terms& terms);
  long lower(long in, int row, int lower, int fields) const;
  std::size_t most_items(const char* kernel) const;
  std::size_t largest_group() const;
  /// @throws InputError if the device's groups cannot hold the tile
  void require_tile() const;
  void make_constant_tables();
  void make_link_tables();
  void make_pressure_tables();
  const Problem& problem_;
  const Model model_;
  const Part* part_;
  const bool is_shared_; ///< the device uses the arena itself
  std::vector<Terms> terms_;
  std::vector<Row> rows_;
  std::set<row_action> actions_; ///< actions of rows_
  StageTile tile_;
  std::vector<typename Tables<T>::extra_link> extra_;
  opencl::Buffer arena_, row_table_, bodies_, masks_, applied_, patterns_, free_lanes_, links_,
      link_index_, pressures_, pressure_index_, face_strains_, extra_table_, signals_;
  Program program_, extra_program_;
  Kernel extra_kernel_;
  /// Set while the host uses the arena of a device that shares the host's memory.
  std::unique_ptr<Mapping> mapping_;
  std::vector<T> signal_values_;
  std::size_t group_size_ = 1, items_across_ = 1; ///< work-items of a group and of a row
  double build_s_ = 0;
  bool is_cached_ = true;
};

/// What was used of the device.
/// @param counts  sum over all queues
template <class T, int W>
DeviceUse use_of(const DeviceProblem<T, W>& problem, const Counts& counts) {
  return {problem.queue.device().entry,
          problem.build_s(),
          problem.is_cached(),
          counts.launches,
          counts.to_device_bytes,
          counts.from_device_bytes,
          counts.transfer_s,
          problem.queue.empty_launch_s()};
}

/// Calls visit(std::integral_constant<int, W>) with the lanes of a layout.
template <class T, class Visit>
auto with_lanes(int lanes, Visit&& visit) {
  if constexpr (sizeof(T) == 8)
    if (lanes == 4) return visit(std::integral_constant<int, 4>{});
  if (lanes == 8) return visit(std::integral_constant<int, 8>{});
  return visit(std::integral_constant<int, 16>{});
}

} // namespace dss::opencl
