#pragma once
/// The wavefront over rows (DESIGN.md section 4): stage s runs `reach` rows behind stage s - 1, intermediate stages
/// live in rings of a few rows, the state is updated in place. A pass is a step, or several of a method in place; threads recompute a halo of
/// reach rows for each of its stages and meet once a pass.
#include "variants/engine/row_storage.hpp"
#include "variants/engine/schedule.hpp"

#include <functional>

namespace dss {

/// A contiguous block of rows with its own storage. What other blocks need of it is published twice over, by parity of
/// the pass, so that one synchronisation a pass is enough: while pass n reads one copy, the other is written for pass n
/// + 1. Halo rows of a part beside its own rows are a remote block: published by messages, computed elsewhere.
template <class T, int W = simd::lanes<T>>
class Block {
public:
  /// @param halo  rows that other blocks read of this one, and this one of them  @param steps  of a pass: with more than one, copies of
  /// the halo's rows are stored beside the block's own, to be stepped with them
  Block(const PackedRows<T, W>& packed, const Method& method, int begin, int end, int fields, int halo, int steps);
  /// A remote block.
  Block(const PackedRows<T, W>& packed, int begin, int end, int fields, int halo);

  int begin, end;
  int stored_begin, stored_end; ///< rows with a place here: own rows, and copies of the halo's
  bool is_remote() const { return state_.empty(); }
  T* row(int r) {
    return state_.data() +
           (packed_->rows[std::size_t(r)].pack_offset - packed_->rows[std::size_t(stored_begin)].pack_offset) *
               pack_size_;
  }
  /// Of a row [numbers].
  std::size_t row_length(int r) const { return std::size_t(packed_->rows[std::size_t(r)].packs) * pack_size_; }
  bool owns(int r) const { return r >= begin && r < end; }
  bool is_published(int r) const {
    return (r < begin + halo_ && begin > 0) || (r >= end - halo_ && end < int(packed_->rows.size()));
  }
  T* published(int r, int parity) {
    return published_[std::size_t(parity)].data() + published_offset_[std::size_t(r - begin)];
  }
  void publish(int r, int parity);
  /// Row r of Y_{stage + 1}, in a ring that holds what stages up to the last still read.
  T* ring_row(int stage, int r) { return ring_rows_[std::size_t(stage)][std::size_t(r)]; }

  std::vector<CarryRings<T>> carry;     ///< one a sweep
  int failed_row = -1, failed_step = 0; ///< step: counted from the first of the pass
  std::size_t bytes() const;

private:
  void make_published();
  const PackedRows<T, W>* packed_;
  std::size_t pack_size_, row_size_;
  int halo_;
  Buffer<T> state_;
  std::array<Buffer<T>, 2> published_;
  std::vector<std::size_t> published_offset_; ///< row after row without gaps: neighbouring rows make one message
  std::vector<Buffer<T>> rings_;
  std::vector<std::vector<T*>>
      ring_rows_; ///< stage, row of the lattice: looked up, since divisions cost as much as a short row
};

/// Signals of some stages as the kernels take them: row s of stage s, in T, and a constant 1 behind them.
template <class T>
class StepSignals {
public:
  StepSignals(std::size_t count, int stages) : count_(count), values_(std::size_t(stages) * (count + 1), T(1)) {}
  void set(const double* rows, int stages) {
    for (std::size_t s = 0; s < std::size_t(stages); ++s)
      for (std::size_t n = 0; n < count_; ++n) values_[s * (count_ + 1) + n] = T(rows[s * count_ + n]);
  }
  const T* stage(int s) const { return values_.data() + std::size_t(s) * (count_ + 1); }

private:
  std::size_t count_;
  std::vector<T> values_;
};

/// How a stage updates the state, in T: beta f plus terms alpha (Y_m - y), the later ones as ratios to the first
/// (kernels/stage_row/row.hpp).
template <class T>
struct StageUpdate {
  row_action action = plain_stage;
  bool is_last = false;
  int low = 0; ///< as in RowTask
  T beta = 0;
  std::vector<std::pair<int, T>> increments; ///< (stage whose output Y_m is; alpha or ratio)
  T smoothing = 0, steps_ahead = 0;          ///< of a leapfrog's prediction (RowTask)
  /// The part of a task that it determines; `stage_output(m)` is the row of the output of stage m.
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
/// One for each stage of the method; `lanes` of a pack. A method with an error stage has a step of 1 here, and each its own in `set`. @throws std::logic_error for more terms in a stage than a task holds.
template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, const RowStorage& storage, int lanes, double dt);
/// Some methods update in place, so a step can follow `reach` rows behind the one before: several steps for one trip through memory, and one
/// meeting of the threads. Measured: eight for a plate; four where a link reaches over a plane of rows, of which eight leave L2. Of several
/// blocks so few that none recomputes more than a sixteenth of its work. @param cuts  as cut_rows gives them
template <class T, int W>
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method, const std::vector<int>& cuts);
/// The last stage of a method that reads the output of stage s.
int last_reader(const Method& method, int s);

/// Steps one block; `blocks` are all blocks. A pass over the rows makes one sweep for each stage of a step or, with a method in place, for
/// several steps. What a sweep does to a row is the same in every pass (but for the parity of what neighbours publish, if it reads that
/// itself), so all row tasks are made once: making them anew would cost as much as several packs of a row.
template <class T, int W = simd::lanes<T>>
class WavefrontStep {
public:
  /// @param steps  of a pass, as all its blocks have them
  WavefrontStep(const PackedRows<T, W>& packed, const Method& method, double dt, const RowStorage& storage,
                std::size_t signal_count, std::vector<Block<T, W>>& blocks, std::size_t index, int steps);
  /// One pass of at most `steps` of the constructor, with the signals of their stages (signal_rows.hpp); `parity` says which published
  /// copies are current. The block's own rows end up updated in place and published under the other parity. Sets the block's
  /// failed_row and failed_step to the first row that the first failing step leaves non-finite.
  void operator()(const double* signals, int steps, int parity);
  /// Calls `done` in each pass as soon as this row is updated and published.
  void watch(int row, std::function<void()> done) {
    watched_row_ = row;
    watched_row_done_ = std::move(done);
  }
  std::size_t bytes() const;
  /// Describes the pass of a parity to one who computes it elsewhere, sweep by sweep: sweep(begin, end), prime(row, task, axis) for what
  /// must come before the first row, row(number, is_whole, task).
  template <class OnSweep, class OnPrime, class OnRow>
  void describe(int parity, OnSweep&& on_sweep, OnPrime&& on_prime, OnRow&& on_row);

private:
  struct RowStage {
    bool is_whole; ///< else this stage needs no more of the row than its links to upper rows
    RowTask<T> task;
  };
  /// One stage of one step over rows [begin, end): the block, and what later sweeps of the pass read on either side.
  struct Sweep {
    int begin, end;
    std::vector<RowStage> rows;
  };
  T* published_row(int r, int parity) const { return published_rows_[std::size_t(parity)][std::size_t(r)]; }
  /// Where a pass has the state of a row: here, or with a neighbour who published it.
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
  std::array<std::vector<T*>, 2> published_rows_; ///< parity, row: those of other blocks that this one reads
  std::array<std::vector<Sweep>, 2>
      sweeps_; ///< parity, sweep; one parity is enough where all that is read is the block's
  int watched_row_ = -1;
  std::function<void()> watched_row_done_;
};

template <class T, int W>
template <class OnSweep, class OnPrime, class OnRow>
void WavefrontStep<T, W>::describe(int parity, OnSweep&& on_sweep, OnPrime&& on_prime, OnRow&& on_row) {
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
