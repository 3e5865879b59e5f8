#pragma once
/// A problem cut into rows of packs: what is constant during a run.
#include "solver/decomposition/part.hpp"
#include "variants/engine/buffer.hpp"
#include "variants/engine/kernel_set.hpp"
#include "variants/engine/layout.hpp"

#include <optional>
#include <vector>

namespace dss {

/// One row of packs. Packs start at multiples of W on the body's grid, so that neighbouring rows agree on lanes.
template <class T>
struct PackedRow {
  int first_pack = 0, packs = 0;
  std::size_t pack_offset = 0; ///< packs of all rows before it
  RowShape shape;
  const KernelSet<T>* kernels =
      nullptr; ///< null until the executor attaches them; always for devices, which have their own
  const BodyConstants<T>* body = nullptr;
  const PackMasks* masks = nullptr;
  const Applied<T>* applied = nullptr;
};

/// W: lanes of a pack, the module's own or a device's.
template <class T, int W = simd::lanes<T>>
class PackedRows {
public:
  static constexpr int lanes = W;
  static constexpr simd::LaneMask all_lanes = simd::LaneMask((1u << W) - 1);
  /// @param part  null, or the part that `problem` is  @param memory  of what devices need too; outlives it
  PackedRows(const Problem& problem, Model model, const Part* part, Memory& memory = Memory::heap());
  PackedRows(const PackedRows&) = delete;
  PackedRows& operator=(const PackedRows&) = delete;

  Memory& memory;
  const Lattice& lattice;
  const ModelLayout layout;
  std::vector<PackedRow<T>> rows;
  int reach = 0;        ///< largest distance in rows of two linked elements
  int packs_across = 0; ///< packs of the widest body's grid
  int max_packs = 0;    ///< packs of the longest row
  int carry_size = 0;   ///< numbers a pack of a carry buffer, largest over the bodies
  int leapfrog_fields = 0;
  int fields() const { return int(layout.fields.size()); }

  /// Packs of rows [begin, end).
  std::size_t packs_of(int begin, int end) const {
    if (begin >= end) return 0;
    const PackedRow<T>& last = rows[std::size_t(end - 1)];
    return last.pack_offset + std::size_t(last.packs) - rows[std::size_t(begin)].pack_offset;
  }
  /// Packs of all rows, and one more: rows look one pack ahead.
  std::size_t readable_packs() const { return packs_of(0, int(rows.size())) + 1; }

  int own_begin = 0,
      own_end = 0; ///< from the first row with an own element to behind the last: all rows of a whole problem
  bool is_part() const { return part_ != nullptr; }
  /// Whether a row has anything to compute in a stage after which `stages_left` more follow before the next exchange: each needs
  /// one layer of halo less.
  bool is_computed(int row, int stages_left) const {
    return row_layer_.empty() || row_layer_[std::size_t(row)] <= stages_left;
  }
  /// Whether computing a row reads halo elements: its own, or those of a row beside it.
  bool reads_halo(int row) const;
  /// First own element of a row that is not finite, if one is. The halo's outermost elements lack links: what becomes of them says
  /// nothing, and they are received anew.
  std::optional<std::size_t> first_failed(int row, const T* packs, int fields) const;

  /// Where a row's extra wrenches go (links outside the grid), or null; six (three) components a pack, in newtons.
  /// Signal: constant 1.
  T* extra_wrench(std::size_t row) { return extra_.empty() ? nullptr : extra_[row].data(); }
  std::size_t bytes() const;

private:
  struct AppliedRow {
    Applied<T> applied;
    std::vector<typename Applied<T>::Pattern> patterns;
    std::vector<Buffer<T>> values;
    std::vector<simd::LaneMask> free_lanes;
  };
  void choose_shapes(const Problem& problem, Model model);
  void find_layers();
  void mark_links();
  void apply_loads(const Problem& problem);
  void apply_clamps(const Problem& problem);
  void apply_extra_links(const Problem& problem);
  AppliedRow& applied_row(std::size_t row);

  const Part* part_;
  std::vector<std::uint8_t> row_layer_; ///< least layer of a row's elements; empty for a whole problem
  std::vector<bool> has_halo_;          ///< rows with an element of the halo
  std::vector<RowShape> shapes_;
  std::vector<BodyConstants<T>> bodies_;
  std::vector<PackMasks> masks_;
  std::vector<int> applied_index_; ///< row -> applied_, or -1
  std::vector<std::unique_ptr<AppliedRow>> applied_;
  std::vector<Buffer<T>> extra_;
};

/// Where an element is.
struct Place {
  std::size_t row;
  int pack, lane; ///< pack counted from the row's first
};
/// Row that holds an element: the last whose first_element is not beyond it.
std::size_t row_of(const Lattice& lattice, std::size_t element);
/// x of every present cell of a row is visited as visit(element, x), in order.
template <class Visit>
void each_cell(const Lattice& lattice, const Row& row, Visit&& visit) {
  std::size_t element = row.first_element;
  for (int x = row.x_begin; x < row.x_end; ++x)
    if (lattice.is_present(row, x)) visit(element++, x);
}
template <class T, int W>
Place place_of(const PackedRows<T, W>& packed, std::size_t element);

/// Constants of a body in the form of the kernels.
template <class T>
BodyConstants<T> body_constants(const Body& body, const Stabilization& tie);
template <class T>
ExtraLinkConstants<T> extra_link_constants(const Problem& problem, const ExtraLink& link);

} // namespace dss
