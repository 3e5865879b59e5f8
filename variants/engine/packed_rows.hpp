#pragma once
/// A problem cut into rows of packs: everything that is constant during a run.
#include "kernels/model.hpp"
#include "solver/decomposition/part.hpp"
#include "solver/model/ensemble.hpp"
#include "variants/api/step_sweeps.hpp"
#include "variants/engine/buffer.hpp"
#include "variants/engine/kernel_set.hpp"
#include "variants/engine/lane_maps.hpp"
#include "variants/engine/link_table.hpp"
#include "variants/engine/pressure_table.hpp"

#include <optional>
#include <set>
#include <span>
#include <vector>

namespace dss {

/// The row that holds an element: the last row whose first_element is not behind it.
std::size_t row_of(const Lattice& lattice, std::size_t element);

/// One row of packs. A pack starts at a multiple of W on the body's grid, so an element has the
/// same lane as its neighbours in the rows beside it. In filled rows it may have another.
template <class T>
struct PackedRow {
  /// First pack on the body's grid, and number of packs.
  int first_pack = 0, packs = 0;
  std::size_t pack_offset = 0; ///< number of packs in all rows before it
  RowShape shape;
  /// Null until the executor sets it. Devices have their own kernels, so there it stays null.
  const KernelSet<T>* kernels = nullptr;
  const BodyConstants<T>* body = nullptr;
  const BodyConstants<LaneNumbers<T>>* members = nullptr; ///< of an ensemble, in place of `body`
  const LinkLanes<T>* links = nullptr;                    ///< null for devices
  const int* link_index = nullptr;                        ///< as in RowTask
  const PackMasks* masks = nullptr;
  const Applied<T>* applied = nullptr;
  const RowPressure<T>* pressure = nullptr; ///< null if its elements have none
  const T* rest = nullptr;                  ///< as in RowTask
  const T* inverse_ratios = nullptr;        ///< as in RowTask
  const PackMaps<T>* maps = nullptr;        ///< null if neighbours have the same lanes
};

/// @tparam W  lanes of a pack: those of the module, or of a device
template <class T, int W = simd::lanes<T>>
class PackedRows {
public:
  static constexpr int lanes = W;
  static constexpr simd::LaneMask all_lanes = simd::LaneMask((1u << W) - 1);
  /// @param part      null, or the part that `problem` is
  /// @param memory    for what devices need too; outlives this object
  /// @param ensemble  null, or an ensemble of W members, of which `problem` is the first
  /// @param furthest  the last form that rows may take (FilledRows)
  /// @param pieces    the problem's lattice with cut rows, which then are not filled
  /// (pass_shape.hpp)
  PackedRows(const Problem& problem, Model model, const Part* part, Memory& memory = Memory::heap(),
             const Ensemble* ensemble = nullptr, RowForm furthest = RowForm::cells,
             Lattice pieces = {});
  PackedRows(const PackedRows&) = delete;
  PackedRows& operator=(const PackedRows&) = delete;

  Memory& memory;
  const Lattice cut; ///< empty if rows are whole
  const Lattice& cells;
  const FilledRows filled;
  const Lattice& lattice; ///< the rows that packs hold: filled.lattice()
  const ModelDescriptor& layout;
  std::vector<PackedRow<T>> rows;
  int reach = 0;        ///< largest distance of two neighbours in the grid [rows]
  int stage_halo = 0;   ///< rows that a stage needs beside its own: reach, or an extra link's
  int packs_across = 0; ///< packs of the widest body's grid; of cut rows: of a piece
  std::vector<int> stage_sizes; ///< packs of the place for a stage of each row
  std::vector<int> links_sizes; ///< packs of the place for the links that each row leaves
  int max_packs = 0;            ///< packs of the longest row
  int tiled_packs = 0;          ///< packs of the longest row that is not merged
  int carry_size = 0; ///< numbers of a pack in a carry buffer; the largest over the bodies
  int leapfrog_fields = 0;
  int pressure_fields = 0; ///< numbers of an element's pressure; the most over the bodies
  int fields() const { return int(layout.fields.size()); }
  bool is_cut() const { return !cut.cuts.empty(); }
  /// A row's first pack, counted from the start of the body's grid, or of the piece.
  int pack_across(int row) const {
    const Row& r = lattice.rows[std::size_t(row)];
    const int piece = is_cut() ? cut.piece_of(r.x_begin) : 0;
    return r.x_begin / W - (piece == 0 ? 0 : cut.cuts[std::size_t(piece) - 1] / W);
  }
  const LaneMaps<T>& maps() const { return maps_; }
  const LinkTable<T, W>& links() const { return links_; }
  const PressureTable<T, W>& pressures() const { return pressures_; }
  /// Calls visit(element, x) for each element of a row, in ascending x of `lattice`.
  template <class Visit>
  void each_element(int row, Visit&& visit) const {
    each_cell(lattice, lattice.rows[std::size_t(row)],
              [&](std::size_t number, int x) { visit(filled.element_at(number), x); });
  }
  /// Calls visit(element, row, x) for elements [first, first + count) in their order.
  template <class Visit>
  void each_element(std::size_t first, std::size_t count, Visit&& visit) const {
    if (count == 0) return;
    for (std::size_t r = row_of(cells, first);
         r < cells.rows.size() && cells.rows[r].first_element < first + count; ++r)
      filled.each_of_cells(int(r), [&](std::size_t element, int, int x) {
        if (element >= first && element < first + count)
          visit(element, std::size_t(filled.row(int(r))), x);
      });
  }

  /// Packs of rows [begin, end).
  std::size_t packs_of(int begin, int end) const {
    if (begin >= end) return 0;
    const PackedRow<T>& last = rows[std::size_t(end - 1)];
    return last.pack_offset + std::size_t(last.packs) - rows[std::size_t(begin)].pack_offset;
  }
  /// Packs of all rows and one more, because rows look one pack ahead.
  std::size_t readable_packs() const { return packs_of(0, int(rows.size())) + 1; }

  /// From the first row with an own element to behind the last such row. A whole problem: all rows.
  int own_begin = 0, own_end = 0;
  bool is_part() const { return part_ != nullptr; }
  /// The sweeps of a step.
  StepSweeps sweeps(const Method& method) const { return {method, *members_.front()}; }
  /// Whether a row is computed in a sweep after which `sweeps_left` more follow before the next
  /// exchange. Each of these needs one layer of halo less.
  bool is_computed(int row, int sweeps_left) const {
    return row_layer_.empty() || row_layer_[std::size_t(row)] <= sweeps_left;
  }
  /// Whether computing a row reads halo elements, in the row itself or in a row beside it.
  bool reads_halo(int row) const;
  /// The first own element of a row that is not finite, if there is one. Halo elements do not
  /// count: the outermost lack links, so their values mean nothing, and all are received anew.
  /// @param member  of an ensemble: whose elements are looked at
  std::optional<std::size_t> first_failed(int row, const T* packs, int fields,
                                          int member = 0) const;

  /// The members of an ensemble, or the problem alone.
  std::span<const Problem* const> members() const { return members_; }
  bool is_ensemble() const { return members_.size() > 1; }
  /// The number of an element of a member among the elements of all.
  std::size_t element_of(std::size_t member, std::size_t element) const {
    return element * members_.size() + member;
  }
  /// Lanes whose results are checked, of an ensemble those of members that have not failed.
  simd::LaneMask live_lanes = all_lanes;
  bool is_live(int member) const { return !is_ensemble() || (live_lanes >> member & 1) != 0; }

  /// Constants of an extra link of all members of an ensemble.
  ExtraLinkConstants<LaneNumbers<T>> member_link_constants(std::size_t link) const;
  /// Where the wrenches [N, N m] of a row's extra links go, or null: layout.wrench components a
  /// pack. They are applied with a signal of constant 1.
  T* extra_wrench(std::size_t row) { return extra_.empty() ? nullptr : extra_[row].data(); }
  std::size_t bytes() const;

private:
  struct AppliedRow {
    Applied<T> applied;
    std::vector<typename Applied<T>::Pattern> patterns;
    std::vector<Buffer<T>> values;
    std::vector<simd::LaneMask> free_lanes;
    /// Lets `applied` have all patterns, on the packs of these.
    void cover_patterns();
  };
  void set_place_sizes();
  void choose_shapes(const Problem& problem, Model model);
  void set_constants();
  void find_layers();
  void mark_links();
  /// Adds the packs of all rows to a LinkTable or PressureTable.
  template <class Table>
  void add_all_packs(Table& table) const;
  void set_link_constants();
  void set_pressures();
  void apply_face_strains();
  void place_at_rest();
  void set_mass_ratios();
  void apply_loads();
  void apply_load(std::size_t n);
  /// Adds a pattern of load n to each row with loaded elements.
  /// @param row_at  (row) -> what the pattern is added to
  /// @param value   (load, component) -> at signal value 1
  template <class RowAt, class Value>
  void add_patterns(std::size_t n, std::size_t components, RowAt&& row_at, Value&& value);
  void apply_clamps();
  void apply_extra_links(const Problem& problem);
  void hand_out_applied();
  AppliedRow& applied_row(std::size_t row);

  const Part* part_;
  LaneMaps<T> maps_; ///< of filled rows
  /// The least layer of a row's elements; empty for a whole problem.
  std::vector<std::uint8_t> row_layer_;
  std::vector<bool> has_halo_; ///< rows with a halo element
  std::vector<RowShape> shapes_;
  std::vector<const Problem*> members_;
  LinkTable<T, W> links_{members_};
  PressureTable<T, W> pressures_{members_};
  /// Of each row, if any has pressures.
  std::vector<RowPressure<T>> row_pressures_;
  std::vector<Buffer<T>> rest_;           ///< of each row, if the frame rotates
  std::vector<Buffer<T>> inverse_ratios_; ///< of each row, if elements differ in mass
  std::vector<std::unique_ptr<AppliedRow>> face_strains_;    ///< of each row; may be null
  std::vector<BodyConstants<T>> bodies_;                     ///< unless it is an ensemble
  std::vector<BodyConstants<LaneNumbers<T>>> member_bodies_; ///< of an ensemble
  /// Equal rows share them, so that they stay in L1.
  std::set<std::vector<PackMasks>> masks_;
  std::vector<int> applied_index_; ///< from row to index in applied_, or -1
  std::vector<std::unique_ptr<AppliedRow>> applied_;
  std::vector<Buffer<T>> extra_;
};

/// The place of an element in rows of packs.
struct Place {
  std::size_t row;
  int pack, lane; ///< pack: counted from the row's first
};
template <class T, int W>
Place place_of(const PackedRows<T, W>& packed, std::size_t element);

/// The constants of a body in the form that the kernels take.
template <class T>
BodyConstants<T> body_constants(const Body& body, const Stabilization& tie);
/// The constants of an extra link in the form that the kernels take.
template <class T>
ExtraLinkConstants<T> extra_link_constants(const Problem& problem, const ExtraLink& link);

} // namespace dss
