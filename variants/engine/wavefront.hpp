#pragma once
/// The wavefront over rows (DESIGN.md section 4). A pass over the rows of a block computes one
/// step, or several steps of a method in place. Each sweep of a pass follows the one before it
/// through the rows (pass_order.hpp). Intermediate stages live in a few rows, and the state is
/// updated in place. Blocks recompute a halo of `stage_halo` rows for each stage of the pass.
/// Threads meet once a pass.
#include "variants/engine/block.hpp"
#include "variants/engine/extra_links.hpp"
#include "variants/engine/pass_places.hpp"
#include "variants/engine/schedule.hpp"
#include "variants/engine/stage_update.hpp"

#include <functional>
#include <optional>

namespace dss {

/// What a block computes for its halo in a pass, over what it computes for itself; the most of all
/// blocks.
/// @param cuts    from cut_rows
/// @param sweeps  of a pass
template <class T, int W>
double halo_work(const PackedRows<T, W>& packed, const std::vector<int>& cuts, int sweeps);

/// Steps that a pass computes. Methods in place can let a step follow the one before it, so several
/// steps need only one trip through memory and one meeting of the threads. Up to eight if links
/// reach one row (a plate), else up to four, since the tiles of more steps would be narrow. With
/// several blocks, only so many that no block recomputes more than a sixteenth of its work.
/// @param cuts  from cut_rows
template <class T, int W>
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method,
                 const std::vector<int>& cuts);

/// What is the same for the passes of all blocks.
struct PassShape {
  int steps = 1; ///< steps of a pass
  SweepForm form;
};

/// Rows across of the tiles of a pass: those asked for, else as many as fit in the caches;
/// no_tiles if that is all.
/// @param cuts   from cut_rows
/// @param extra  rows of the extra links
/// @param asked  as Setup::tile
/// @throws InputError if the tile that was asked for does not fit in the caches
template <class T, int W>
int choose_tile(const PackedRows<T, W>& packed, const Method& method, const RowStorage& storage,
                int steps, const std::vector<int>& cuts, bool is_in_row_order,
                std::span<const LinkedRows> extra, int asked);

/// Steps one block. What a task does to a row is the same in every pass, except for the parity of
/// the published rows that it reads. So all row tasks are made once: making them anew would cost as
/// much as several packs of a row.
template <class T, int W = simd::lanes<T>>
class WavefrontStep {
public:
  /// @param dt      step [s]; of an ensemble: of each member
  /// @param blocks  all blocks
  /// @param index   of this block
  /// @param shape   the same for all blocks
  WavefrontStep(PackedRows<T, W>& packed, const Method& method, std::span<const double> dt,
                const RowStorage& storage, std::size_t signal_count,
                std::vector<Block<T, W>>& blocks, std::size_t index, PassShape shape,
                const ExtraLinks<T, W>& extra_links);
  /// Computes one pass. It updates the block's own rows in place and publishes them under the other
  /// parity. Sets the block's failures. Steps after a failure are left out, except of an ensemble,
  /// where the other members go on.
  /// @param signals  rows of the pass's stages (signal_rows.hpp)
  /// @param steps    at most those of the constructor
  /// @param parity   which published copies are current
  void operator()(const double* signals, int steps, int parity);
  /// Calls `done` in each pass as soon as this row and all before it are updated and published.
  void watch(int row, std::function<void()> done);
  std::size_t bytes() const;

  struct RowStage {
    RowWork work;
    bool is_published; ///< the task leaves a new state that other blocks read
    int sweep;
    int row; ///< of an extra link: its number; of a sum: ExtraLinks::index_of its row
    const KernelSet<T>* kernels; ///< null for devices and for extra links
    /// Of an extra link: `in` and `base` are the rows of its elements. Of a sum: `out`.
    RowTask<T> task;
  };
  /// The tasks of the passes of a parity, in their order.
  const std::vector<RowStage>& tasks(int parity) const {
    return tasks_[tasks_[1].empty() ? 0 : std::size_t(parity)];
  }

private:
  T* published_row(int r, int parity) const {
    return published_rows_[std::size_t(parity)][std::size_t(r)];
  }
  /// The place of a row's state during a pass: in this block, or published by a neighbour.
  T* stepped_row(int r, int parity) {
    const bool is_here = r >= block_.stored_begin && r < block_.stored_end;
    return is_here ? block_.row(r) : published_row(r, parity);
  }
  /// Row r of Y_{stage + 1}, the output of a stage.
  T* stage_row(int stage, int r) {
    return stage_rows_.data() + std::size_t(places_->stage_row(stage, r)) * row_size_;
  }
  T* input_row(int stage, int r, int parity) {
    return stage == 0 ? stepped_row(r, parity) : stage_row(stage - 1, r);
  }
  /// Where a row leaves links for its upper rows.
  T* links(int axis, int sweep, int r) {
    return links_[std::size_t(axis) - 1].data() +
           std::size_t(places_->links(axis, sweep, r)) * links_size_;
  }
  void find_published_rows(std::vector<Block<T, W>>& blocks);
  void copy_halo(int parity);
  std::vector<PassTask> order(SweepForm form) const;
  void make_places(const std::vector<PassTask>& order);
  std::vector<RowStage> make_tasks(const std::vector<PassTask>& order, int parity);
  RowStage extra_task(const PassTask& what, int parity);
  /// The links of a sweep, as set_row takes them.
  struct SweepLinks {
    WavefrontStep& step;
    int sweep;
    T* y(int row) const { return step.links(1, sweep, row); }
    T* z(int row) const { return step.links(2, sweep, row); }
  };
  static void fetch(const RowStage& next);
  /// @return false if a result is not finite
  bool compute(const RowStage& stage);
  /// Looks for elements of a row that are not finite after a step.
  /// @return whether there is one
  bool note_failures(const RowStage& stage);
  void plan_fetches(const std::vector<PassTask>& order, int parity, std::vector<RowStage>& tasks);

  const PackedRows<T, W>& packed_;
  const int fields_, stages_, steps_;
  const std::size_t row_size_, links_size_; ///< of a place [numbers]
  Block<T, W>& block_;
  StepSignals<T> signals_;
  std::vector<StageUpdate<T>> updates_; ///< of each stage
  ExtraLinks<T, W> extra_links_;
  ExtraWrenches<T> extra_wrenches_;
  /// [parity][row]: rows of other blocks that this one reads.
  std::array<std::vector<T*>, 2> published_rows_;
  std::optional<PassPlaces> places_; ///< until all tasks are made
  Buffer<T> stage_rows_;
  std::array<Buffer<T>, 2> links_; ///< across y, z
  /// [parity]. One parity is enough if the block stores all rows that it reads.
  std::array<std::vector<RowStage>, 2> tasks_;
  int watched_row_ = -1;
  /// Index of the task after which the watched row and all before it are done; -1: none.
  std::ptrdiff_t watched_task_ = -1;
  std::function<void()> watched_rows_done_;
};

} // namespace dss
