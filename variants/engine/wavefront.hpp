#pragma once
/// The wavefront over rows (DESIGN.md section 4). Stage s runs `reach` rows behind stage s - 1.
/// Intermediate stages live in rings of a few rows, and the state is updated in place. A pass over
/// the rows computes one step, or several steps of a method in place. Each thread recomputes a halo
/// of `reach` rows for each stage of the pass. The threads meet once a pass.
#include "variants/engine/row_storage.hpp"
#include "variants/engine/schedule.hpp"

#include <functional>

namespace dss {

/// A contiguous block of rows with its own storage. The rows that other blocks read are published
/// in two copies, one for each parity of the pass. So one synchronisation a pass is enough: pass n
/// reads one copy and writes the other for pass n + 1. The halo rows of a part before or behind its
/// own rows are a remote block: messages publish it, another part computes it.
template <class T, int W = simd::lanes<T>>
class Block {
public:
  /// @param fields  numbers that a pack holds for each element
  /// @param halo    rows that other blocks read of this one, and this one of them
  /// @param steps   steps of a pass; if more than one, the block also stores copies of the halo's
  ///   rows and steps them
  Block(const PackedRows<T, W>& packed, const Method& method, int begin, int end, int fields,
        int halo, int steps);
  /// Makes a remote block.
  Block(const PackedRows<T, W>& packed, int begin, int end, int fields, int halo);

  int begin, end;
  int stored_begin, stored_end; ///< rows that are stored here: own rows, and copies of the halo's
  bool is_remote() const { return state_.empty(); }
  T* row(int r) {
    return state_.data() + (packed_->rows[std::size_t(r)].pack_offset -
                            packed_->rows[std::size_t(stored_begin)].pack_offset) *
                               pack_size_;
  }
  /// Length of a row [numbers].
  std::size_t row_length(int r) const {
    return std::size_t(packed_->rows[std::size_t(r)].packs) * pack_size_;
  }
  bool owns(int r) const { return r >= begin && r < end; }
  bool is_published(int r) const {
    return (r < begin + halo_ && begin > 0) ||
           (r >= end - halo_ && end < int(packed_->rows.size()));
  }
  T* published(int r, int parity) {
    return published_[std::size_t(parity)].data() + published_offset_[std::size_t(r - begin)];
  }
  void publish(int r, int parity);
  /// Row r of Y_{stage + 1}, the output of a stage, in a ring. The ring keeps a row until the last
  /// stage that reads it.
  T* ring_row(int stage, int r) { return ring_rows_[std::size_t(stage)][std::size_t(r)]; }

  std::vector<CarryRings<T>> carry; ///< one for each sweep
  /// The failed step counts from the first of the pass.
  int failed_row = -1, failed_step = 0;
  std::size_t bytes() const;

private:
  void make_published();
  const PackedRows<T, W>* packed_;
  std::size_t pack_size_, row_size_;
  int halo_;
  Buffer<T> state_;
  std::array<Buffer<T>, 2> published_;
  /// Published rows follow one another without gaps, so that neighbouring rows make one message.
  std::vector<std::size_t> published_offset_;
  std::vector<Buffer<T>> rings_;
  /// [stage][row of the lattice]. A table, because a division would cost as much as a short row.
  std::vector<std::vector<T*>> ring_rows_;
};

/// Signals of some stages as the kernels take them: one row for each stage, in numbers of type T,
/// followed by a constant 1.
template <class T>
class StepSignals {
public:
  StepSignals(std::size_t count, int stages)
      : count_(count), values_(std::size_t(stages) * (count + 1), T(1)) {}
  void set(const double* rows, int stages) {
    for (std::size_t s = 0; s < std::size_t(stages); ++s)
      for (std::size_t n = 0; n < count_; ++n)
        values_[s * (count_ + 1) + n] = T(rows[s * count_ + n]);
  }
  const T* stage(int s) const { return values_.data() + std::size_t(s) * (count_ + 1); }

private:
  std::size_t count_;
  std::vector<T> values_;
};

/// How a stage updates the state: out = y + beta f + sum of alpha (Y_m - y). Later alphas are
/// ratios to the first (kernels/stage_row/row.hpp).
template <class T>
struct StageUpdate {
  row_action action = plain_stage;
  bool is_last = false;
  int low = 0; ///< as RowTask::low
  T beta = 0;
  /// Pairs of the stage m whose output is Y_m, and of alpha or its ratio.
  std::vector<std::pair<int, T>> increments;
  T smoothing = 0, steps_ahead = 0; ///< of a leapfrog's prediction, see RowTask
  /// Sets what this update determines of a task.
  /// @param base, out     rows of the present state and of the result
  /// @param stage_output  function from m to the row of the output of stage m
  /// @param step          length of the step, if the method has an error stage [s]
  template <class StageOutput>
  void set(RowTask<T>& task, T* base, T* out, StageOutput&& stage_output, T step = 1) const {
    task.action = action;
    task.is_last = is_last;
    task.low = low;
    task.base = base;
    task.out = out;
    task.beta = step * beta;
    task.increments = int(increments.size());
    task.alpha[0] = smoothing, task.alpha[1] = steps_ahead;
    for (std::size_t m = 0; !increments.empty() && m < std::size(task.alpha); ++m) {
      const bool is_used = m < increments.size();
      task.increment[m] = stage_output(increments[is_used ? m : 0].first);
      task.alpha[m] = is_used ? increments[m].second : T(0);
    }
  }
};
/// The update of each stage of the method. With a method with an error stage, these have a step of
/// 1, and set() gets the length of each step.
/// @param lanes  lanes of a pack
/// @param dt     step [s]
/// @throws std::logic_error if a stage has more increments than a task holds
template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, const RowStorage& storage,
                                          int lanes, double dt);
/// Steps that a pass computes. Methods in place can let a step follow `reach` rows behind the one
/// before it, so several steps need only one trip through memory and one meeting of the threads. Up
/// to eight if links reach one row (a plate), else up to four, since more rows would leave the L2
/// cache. With several blocks, only so many that no block recomputes more than a sixteenth of its
/// work.
/// @param cuts  from cut_rows
template <class T, int W>
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method,
                 const std::vector<int>& cuts);
/// The last stage that reads the output of stage s.
int last_reader(const Method& method, int s);

/// Steps one block. A pass makes one sweep over the rows for each stage of its steps. What a sweep
/// does to a row is the same in every pass, except for the parity of the published rows that it
/// reads. So all row tasks are made once: making them anew would cost as much as several packs of a
/// row.
template <class T, int W = simd::lanes<T>>
class WavefrontStep {
public:
  /// @param dt      step [s]
  /// @param blocks  all blocks
  /// @param index   of this block
  /// @param steps   steps of a pass, the same for all blocks
  WavefrontStep(const PackedRows<T, W>& packed, const Method& method, double dt,
                const RowStorage& storage, std::size_t signal_count,
                std::vector<Block<T, W>>& blocks, std::size_t index, int steps);
  /// Computes one pass. It updates the block's own rows in place and publishes them under the other
  /// parity. Sets the block's failed_row and failed_step to the first row that is non-finite after
  /// the first failing step.
  /// @param signals  rows of the pass's stages (signal_rows.hpp)
  /// @param steps    at most those of the constructor
  /// @param parity   which published copies are current
  void operator()(const double* signals, int steps, int parity);
  /// Calls `done` in each pass as soon as this row is updated and published.
  void watch(int row, std::function<void()> done) {
    watched_row_ = row;
    watched_row_done_ = std::move(done);
  }
  std::size_t bytes() const;
  /// Describes the pass of a parity to code that computes it elsewhere, sweep by sweep:
  /// on_sweep(begin, end); on_prime(row, task, axis) for links that must come before the first row;
  /// on_row(row, is_whole, task).
  template <class OnSweep, class OnPrime, class OnRow>
  void describe(int parity, OnSweep&& on_sweep, OnPrime&& on_prime, OnRow&& on_row);

private:
  struct RowStage {
    bool is_whole; ///< false: this stage needs only the row's links to upper rows
    RowTask<T> task;
  };
  /// One stage of one step over rows [begin, end): those of the block, and rows on both sides that
  /// later sweeps of the pass read.
  struct Sweep {
    int begin, end;
    std::vector<RowStage> rows;
  };
  T* published_row(int r, int parity) const {
    return published_rows_[std::size_t(parity)][std::size_t(r)];
  }
  /// The place of a row's state during a pass: in this block, or published by a neighbour.
  T* stepped_row(int r, int parity) {
    const bool is_here = r >= block_.stored_begin && r < block_.stored_end;
    return is_here ? block_.row(r) : published_row(r, parity);
  }
  T* input_row(int stage, int r, int parity) {
    return stage == 0 ? stepped_row(r, parity) : block_.ring_row(stage - 1, r);
  }
  void find_published_rows(std::vector<Block<T, W>>& blocks);
  void fetch_halo(int parity);
  std::vector<Sweep> make_sweeps(const std::vector<StageUpdate<T>>& updates, int parity);

  const PackedRows<T, W>& packed_;
  const int fields_, stages_, steps_;
  Block<T, W>& block_;
  StepSignals<T> signals_;
  /// [parity][row]: rows of other blocks that this one reads.
  std::array<std::vector<T*>, 2> published_rows_;
  /// [parity][sweep]. One parity is enough if the block stores all rows that it reads.
  std::array<std::vector<Sweep>, 2> sweeps_;
  int watched_row_ = -1;
  std::function<void()> watched_row_done_;
};

template <class T, int W>
template <class OnSweep, class OnPrime, class OnRow>
void WavefrontStep<T, W>::describe(int parity, OnSweep&& on_sweep, OnPrime&& on_prime,
                                   OnRow&& on_row) {
  const std::vector<Sweep>& sweeps = sweeps_[sweeps_[1].empty() ? 0 : std::size_t(parity)];
  for (std::size_t n = 0; n < sweeps.size(); ++n) {
    const Sweep& sweep = sweeps[n];
    on_sweep(sweep.begin, sweep.end);
    if (sweep.begin > 0)
      each_prime(
          packed_, sweep.begin, fields_, block_.carry[n],
          [&](int row) { return input_row(int(n) % stages_, row, parity); }, on_prime);
    for (std::size_t r = 0; r < sweep.rows.size(); ++r)
      on_row(sweep.begin + int(r), sweep.rows[r].is_whole, sweep.rows[r].task);
  }
}

} // namespace dss
