#pragma once
/// The wavefront over rows (DESIGN.md section 4). A pass over the rows of a block computes one
/// step, or several steps of a method in place. Each sweep of a pass follows the one before it
/// through the rows (pass_order.hpp). Intermediate stages live in a few rows, and the state is
/// updated in place. Where blocks meet, seams.hpp says what each computes.
#include "variants/engine/blocks.hpp"
#include "variants/engine/extra_links.hpp"
#include "variants/engine/pass_places.hpp"
#include "variants/engine/pass_shape.hpp"
#include "variants/engine/progress.hpp"
#include "variants/engine/schedule.hpp"
#include "variants/engine/stage_update.hpp"

#include <functional>
#include <optional>

namespace dss {

/// Steps one block. What a task does to a row is the same in every pass, except for the parity of
/// the published rows that it reads. So all row tasks are made once: making them anew would cost as
/// much as several packs of a row.
template <class T, int W = simd::lanes<T>>
class WavefrontStep {
public:
  /// @param dt     step [s]; of an ensemble: of each member
  /// @param block  which this is, counted from the first own one
  WavefrontStep(PackedRows<T, W>& packed, const Method& method, std::span<const double> dt,
                const RowStorage& storage, std::size_t signal_count, Blocks<T, W>& blocks,
                int block, PassShape shape, const ExtraLinks<T, W>& extra_links);
  /// The order of the tasks of a pass.
  /// @param sweeps  places of the rows of each
  std::vector<PassTask> order(std::span<const SweepRows> sweeps) const;
  /// Takes memory for what the tasks leave for one another and for other blocks.
  void make_places(const std::vector<PassTask>& order, const PassReads& reads, const Seams& seams);
  /// @param all  the steps of all blocks, which have their places
  void make_tasks(const std::vector<PassTask>& order, std::span<WavefrontStep> all);
  /// When the tasks of all blocks are made.
  void forget_places() { places_.reset(); }
  /// Computes one pass. It updates rows in place and publishes them under the other parity. Sets
  /// the block's failures. Steps after a failure are left out, except of an ensemble, where the
  /// other members go on.
  /// @param signals   rows of the pass's stages (signal_rows.hpp)
  /// @param steps     at most those of the shape
  /// @param parity    which published copies are current
  /// @param pass      how many passes were computed since all progress was reset
  /// @param progress  of each block
  void operator()(const double* signals, int steps, int parity, long pass,
                  std::span<Progress> progress);
  /// Calls `done` in each pass as soon as this row and all before it are updated and published.
  void watch(int row, std::function<void()> done);
  /// Of its extra links.
  std::span<const LinkedRows> linked_rows() const { return extra_links_.rows(); }
  std::size_t bytes() const;

  struct RowStage {
    RowWork work;
    int sweep;
    int row;           ///< of an extra link: its number; of a sum: ExtraLinks::index_of its row
    bool is_published; ///< the task leaves a new state that others read
    const KernelSet<T>* kernels; ///< null for devices and for extra links
    /// Of an extra link: `in` and `base` are the rows of its elements. Of a sum: `out`.
    RowTask<T> task;
    T* kept = nullptr; ///< where the row goes before the task overwrites it, for other blocks
  };
  /// The tasks of the passes of a parity, in their order.
  const std::vector<RowStage>& tasks(int parity) const {
    return tasks_[tasks_[1].empty() ? 0 : std::size_t(parity)];
  }

private:
  /// The place of a row's state during a pass: in a block, or published by one.
  T* state_row(int r, int parity) {
    return own().owns(r) ? own().row(r) : others_rows_[std::size_t(parity)][std::size_t(r)];
  }
  /// An output of this block, as Seams counts them: row r of Y_{output + 1}, or the row that a
  /// sweep overwrites.
  T* output_row(int output, int r) {
    const int place = seams_->handed_over(block_, output, r);
    return place != Seams::nowhere
               ? handed_over_.data() + std::size_t(place) * pack_size_
               : stage_rows_.data() + std::size_t(places_->stage_row(output, r)) * pack_size_;
  }
  /// Row r of Y_{stage + 1}, of the block that computes it.
  T* stage_row(int stage, int r) {
    const int owner = seams_->owner(sweeps_.of_stage(stage), r, block_);
    return all_[std::size_t(owner)].output_row(stage, r);
  }
  T* input_row(int sweep, int r, int parity);
  /// Sweeps of a pass.
  int sweep_count() const { return shape_.steps * sweeps_.count(); }
  /// Where a row leaves links for its upper rows.
  T* links(int axis, int sweep, int r) {
    return links_[std::size_t(axis)].data() +
           std::size_t(places_->links(axis, sweep, r)) * std::size_t(packed_.carry_size);
  }
  Block<T, W>& own() { return blocks_.all()[blocks_.first_own() + std::size_t(block_)]; }
  const RowDivision& division() const { return blocks_.division(); }
  bool is_recomputed() const { return division().seams == SeamKind::recomputed; }
  /// Whether this block answers for a row's new state: whether it is finite, and published.
  bool answers_for(int r) {
    const int place = division().order.place(r);
    return is_recomputed() ? own().owns(r)
                           : place >= division().cuts.front() && place < division().cuts.back();
  }
  void find_others_rows();
  std::vector<RowStage> tasks_of(const std::vector<PassTask>& order, int parity);
  RowStage extra_task(const PassTask& what, int parity);
  /// The links of a sweep, as set_row takes them.
  struct SweepLinks {
    WavefrontStep& step;
    int sweep;
    T* x(int row) const { return step.links(0, sweep, row); }
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
  const PassShape shape_;
  const int fields_;
  const StepSweeps sweeps_; ///< of a step
  const std::size_t pack_size_;
  Blocks<T, W>& blocks_;
  const int block_;
  const bool has_published_; ///< blocks exchange rows with others
  const Seams* seams_ = nullptr;
  StepSignals<T> signals_;
  std::vector<StageUpdate<T>> updates_; ///< of each stage
  ExtraLinks<T, W> extra_links_;
  ExtraWrenches<T> extra_wrenches_;
  /// [parity][row]: the state of rows of other blocks that this one reads; until all tasks are
  /// made.
  std::array<std::vector<T*>, 2> others_rows_;
  std::optional<PassPlaces> places_; ///< until all tasks are made
  std::span<WavefrontStep> all_;     ///< while tasks are made
  Buffer<T> stage_rows_,
      handed_over_;                ///< places of outputs; one pack more beyond each of the latter
  std::array<Buffer<T>, 3> links_; ///< across x, y, z
  /// [parity]. One parity is enough if the block reads no published rows.
  std::array<std::vector<RowStage>, 2> tasks_;
  int watched_row_ = -1;
  /// Index of the task after which the watched row and all before it are done; -1: none.
  std::ptrdiff_t watched_task_ = -1;
  std::function<void()> watched_rows_done_;
};

/// The steps of all own blocks.
template <class T, int W = simd::lanes<T>>
class Wavefront {
public:
  /// @param blocks  all blocks, of as many sweeps; outlives this object
  /// The other parameters are those of WavefrontStep.
  Wavefront(PackedRows<T, W>& packed, const Method& method, std::span<const double> dt,
            const RowStorage& storage, std::size_t signal_count, Blocks<T, W>& blocks,
            PassShape shape, const ExtraLinks<T, W>& extra_links);
  Wavefront(const Wavefront&) = delete;
  Wavefront& operator=(const Wavefront&) = delete;
  const std::vector<WavefrontStep<T, W>>& steps() const { return steps_; }
  WavefrontStep<T, W>& step(int block) { return steps_[std::size_t(block)]; }
  /// Before the first pass of each run of passes, whose numbers start at 0.
  /// @param is_crowded  more threads than cores will compute the blocks
  void start(bool is_crowded) {
    for (Progress& progress : progress_) progress.reset(is_crowded);
  }
  /// Computes a pass of a block (see WavefrontStep). Each block's passes must follow one another,
  /// and each block must compute every pass, or leave. A thread with several blocks goes from the
  /// last to the first in each pass; else it would wait for itself.
  void pass(int block, const double* signals, int steps, int parity, long pass) {
    step(block)(signals, steps, parity, pass, progress_);
  }
  /// The other blocks wait for this one no more.
  void leave(int block) { progress_[std::size_t(block)].leave(); }
  std::size_t bytes() const;

private:
  std::vector<WavefrontStep<T, W>> steps_;
  std::optional<Seams> seams_;
  std::vector<Progress> progress_; ///< of each block
};

} // namespace dss
