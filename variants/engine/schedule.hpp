#pragma once
/// The row tasks that all schedules consist of, and carry buffers.
#include "variants/engine/packed_rows.hpp"

#include <vector>

namespace dss {

/// Carry buffers of one stage, for rows that are computed in the order of their numbers. They hold
/// the link forces that a row leaves for its upper neighbours: across y the next row (of cut rows
/// at most `reach` rows ahead), across z a row at most `reach` rows ahead. A row reads what its
/// lower neighbour left before it writes its own forces to the same place. So rings of so many rows
/// are enough. Filled rows need one more, since their packs read what was left for several packs.
/// The pieces of a cut row leave one another a pack, for which one place is enough.
template <class T>
class CarryRings {
public:
  CarryRings() = default;
  template <int W>
  explicit CarryRings(const PackedRows<T, W>& packed)
      : rows_y_(packed.filled.is_any() ? 2
                : packed.is_cut()      ? packed.reach
                                       : 1),
        rows_z_(packed.is_cut() ? packed.reach : packed.reach + rows_y_ - 1),
        row_size_(std::size_t(packed.packs_across) * std::size_t(packed.carry_size)),
        data_(std::size_t(rows_y_ + rows_z_) * row_size_ + std::size_t(packed.carry_size),
              packed.memory) {}
  T* x(int) { return data_.data() + std::size_t(rows_y_ + rows_z_) * row_size_; }
  /// Ring rows start at pack 0 of the body's grid, so that rows with different first packs agree.
  /// Those of cut rows start at a cut.
  T* y(int row) { return data_.data() + std::size_t(row % rows_y_) * row_size_; }
  T* z(int row) { return data_.data() + std::size_t(rows_y_ + row % rows_z_) * row_size_; }
  std::size_t bytes() const { return data_.bytes(); }

private:
  int rows_y_ = 1, rows_z_ = 0;
  std::size_t row_size_ = 0;
  Buffer<T> data_;
};

/// Fills the part of a task that depends on the row and its neighbours: masks, constants, input
/// rows, carry buffers.
/// @param fields  numbers that a pack of an input row holds for each element
/// @param carry   x(row), y(row) and z(row) are the buffers for the links that a row leaves
/// @param input   function from a row's number to the address of its input
template <class T, int W, class Carry, class Input>
void set_row(RowTask<T>& task, const PackedRows<T, W>& packed, int row, int fields, Carry&& carry,
             Input&& input) {
  const PackedRow<T>& p = packed.rows[std::size_t(row)];
  const Row& r = packed.lattice.rows[std::size_t(row)];
  const std::ptrdiff_t pack_size = std::ptrdiff_t(fields) * W;
  const std::ptrdiff_t carry_offset =
      std::ptrdiff_t(packed.pack_across(row)) * p.shape.carry_components * W;
  const auto aligned = [&](int upper) -> const T* {
    return input(upper) + (p.first_pack - packed.rows[std::size_t(upper)].first_pack) * pack_size;
  };
  task.packs = p.packs;
  task.stride = int(pack_size);
  task.masks = p.masks;
  task.maps = p.maps;
  task.places = packed.maps().places();
  task.body = p.body;
  task.members = p.members;
  task.links = p.links;
  task.link_index = p.link_index;
  task.live_lanes = &packed.live_lanes;
  task.applied = p.applied;
  task.pressure = p.pressure;
  task.rest = p.rest;
  task.inverse_ratios = p.inverse_ratios;
  task.in = input(row);
  task.ahead = r.upper_x >= 0 ? input(r.upper_x) : task.in + p.packs * pack_size;
  if (r.upper_x >= 0) task.carry_x = carry.x(row);
  if (r.lower_x >= 0) task.from_x = carry.x(r.lower_x);
  if (r.upper_y >= 0) task.upper_y = aligned(r.upper_y), task.carry_y = carry.y(row) + carry_offset;
  if (r.lower_y >= 0) task.from_y = carry.y(r.lower_y) + carry_offset;
  if (r.upper_z >= 0) task.upper_z = aligned(r.upper_z), task.carry_z = carry.z(row) + carry_offset;
  if (r.lower_z >= 0) task.from_z = carry.z(r.lower_z) + carry_offset;
}

/// Finds the pressures of a row, if its elements have any.
template <class T>
void find_pressures(const KernelSet<T>& kernels, const RowTask<T>& task) {
  if (task.pressure != nullptr) kernels.pressure(task);
}
/// Computes only the links that a row leaves for its upper neighbour across an axis; their strains
/// in a sweep for pressures.
template <class T>
void leave_links(const KernelSet<T>& kernels, const RowTask<T>& task, int axis, bool is_pressure) {
  if (!is_pressure)
    kernels.prime(task, axis);
  else if (task.pressure != nullptr)
    kernels.prime_pressure(task, axis);
}
/// The same for all upper neighbours.
template <class T>
void prime_uppers(const KernelSet<T>& kernels, const RowTask<T>& task, bool is_pressure = false) {
  if (task.carry_x != nullptr) leave_links(kernels, task, 0, is_pressure);
  if (task.upper_y != nullptr) leave_links(kernels, task, 1, is_pressure);
  if (task.upper_z != nullptr) leave_links(kernels, task, 2, is_pressure);
}

/// Calls visit(row, task, axis) for the links that rows before `begin` leave for rows from `begin`
/// on. A block whose rows are computed in the order of their numbers needs them before its first.
template <class T, int W, class Input, class Visit>
void each_prime(const PackedRows<T, W>& packed, int begin, int fields, CarryRings<T>& carry,
                Input&& input, Visit&& visit) {
  const auto prime = [&](int lower, int axis) {
    RowTask<T> task;
    set_row(task, packed, lower, fields, carry, input);
    visit(lower, task, axis);
  };
  const int rows = int(packed.rows.size());
  if (begin >= rows) return;
  if (const int lower = packed.lattice.rows[std::size_t(begin)].lower_y; lower >= 0)
    prime(lower, 1);
  for (int row = begin; row < rows && row < begin + packed.reach; ++row)
    if (const int lower = packed.lattice.rows[std::size_t(row)].lower_z;
        lower >= 0 && lower < begin)
      prime(lower, 2);
}

} // namespace dss
