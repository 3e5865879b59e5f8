#pragma once
/// The executor of every CPU variant. It converts states, starts and reads the methods, and runs
/// the schedule on a team of threads.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api/api.hpp"
#include "variants/engine/blocks.hpp"
#include "variants/engine/staged.hpp"
#include "variants/engine/state_rows.hpp"
#include "variants/engine/wavefront.hpp"

#include <atomic>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

namespace dss {

/// The first failure of a run, or of a member. Several threads may meet one at the same time.
class FirstFailure {
public:
  bool is_met() const { return step_ >= 0; }
  long step() const { return step_; }
  void meet(long step, std::size_t element) {
    const std::lock_guard lock(mutex_);
    if (step_ < 0 || step < step_ || (step == step_ && element < element_))
      step_ = step, element_ = element;
  }
  Outcome outcome(long steps) const {
    return is_met() ? Outcome{false, step_, element_} : Outcome{true, steps, 0};
  }

private:
  std::mutex mutex_;
  std::atomic<long> step_{-1};
  std::size_t element_ = 0;
};

/// Computes a problem, or a part of one, in numbers of type T. The schedule is either the wavefront
/// (blocks_, wavefront_) or stage by stage (staged_).
template <class T>
class RowExecutor final : public Executor,
                          public StepTrials,
                          public PartHalos,
                          public StateTransfer,
                          public MemberOutcomes {
public:
  explicit RowExecutor(const Setup& setup);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
  StepTrials* step_trials() override { return this; }
  PartHalos* part_halos() override { return this; }
  StateTransfer* state_transfer() override { return this; }
  StepMaxima try_step(double dt, std::span<const double> signals) override;
  void accept_step() override;
  std::string schedule() const override;
  std::size_t bytes() const override;
  int workers() const override { return staged_ ? staged_->threads() : threads_; }
  int halo_copies() const override { return staged_ ? staged_->copies() : 2; }
  HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) override;
  int halo_lanes() const override { return packed_.filled.is_any() ? 0 : W; }
  int kept_fields() const override { return rows_.kept_fields(); }
  void save(std::size_t first, std::span<double> kept) override;
  void restore(std::size_t first, std::span<const double> kept) override;
  MemberOutcomes* member_outcomes() override { return packed_.is_ensemble() ? this : nullptr; }
  std::span<const Outcome> outcomes() const override { return outcomes_; }

private:
  static constexpr int W = simd::lanes<T>;
  int stored_fields() const { return rows_.stored_fields(); }
  bool is_part() const { return part_ != nullptr; }
  /// Finds why the wavefront does not serve; empty if it does.
  std::string_view why_staged();
  void make_blocks();
  T* row(int r);
  /// Two places of a row of a copy that parts exchange: where it is kept, and its other place or
  /// null.
  std::pair<T*, T*> copy_row(int copy, int r);
  int current_copy() const { return staged_ ? staged_->current_copy() : parity_; }
  void exchange(void (Halo::*act)(Side, int), int copy) {
    for (const Side side : all_sides) (part_->halo.*act)(side, copy);
  }
  /// Exchanges the whole halo of the present state. All parts must call it.
  void refresh_halo();
  /// Computes the rates of all model fields at the present state, in plain packs, row by row in the
  /// order of numbers. A row may be changed when it is done.
  /// @param rates  (row) -> where its rates go
  /// @param done   called with each row after its rates
  template <class Rates, class Done>
  void evaluate(std::span<const double> signals, Rates&& rates, Done&& done);
  /// The rates of all rows, plain (StateRows::plain_offset).
  Buffer<T> all_rates(std::span<const double> signals);
  void start_leapfrog(std::span<const double> signals);
  /// Moves the velocities from the half step to the present time. Then the stored state is what
  /// read() returns.
  void stop_leapfrog();
  Outcome run_blocks(long steps, std::span<const double> signals);
  /// One step of a part by one thread. It sends as early and receives as late as possible.
  void step_overlapped(const double* signals, long pass, int parity, bool is_last);
  Outcome run_staged(long steps, std::span<const double> signals);

  /// Numbers of a row of signals.
  std::size_t signal_width() const {
    return signal_count(setup_.problem) * packed_.members().size();
  }
  /// Checks the lanes of these members no more.
  void leave_out(const std::vector<FirstFailure>& failures);
  /// Makes the outcomes of the last advance, and leaves out the members that failed.
  Outcome outcome_of(const std::vector<FirstFailure>& failures, long steps);
  /// Whether all members failed before a step; false while one is left.
  bool have_all_failed(const std::vector<FirstFailure>& failures, long before) const;
  void revive_members();

  const Setup setup_;
  const PartSetup* part_; ///< null for a whole problem and for a part without neighbours
  /// The rows, cut if they are too long for the wavefront.
  struct Rows {
    std::unique_ptr<PackedRows<T>> packed;
    int tile = no_tiles; ///< pieces of a tile, if rows are cut
  };
  static Rows make_rows(const Setup& setup);
  const Rows made_;
  PackedRows<T>& packed_ = *made_.packed;
  const StepSweeps sweeps_{setup_.method, setup_.problem};
  StateRows<T> rows_;
  std::string_view why_staged_;
  RowDivision division_; ///< of the wavefront
  Blocks<T> blocks_;     ///< of the wavefront
  std::optional<Wavefront<T>> wavefront_;
  int threads_ = 1;
  PassShape shape_;
  std::optional<StagedRows<T>> staged_; ///< stage by stage, in place of blocks_ and wavefront_
  int parity_ = 0;
  bool is_started_ = false; ///< leapfrog: the stored velocities are those of the last half step
  std::vector<double> end_signals_;
  /// Leapfrog: rates at the end of the last advance, computed when first read.
  Buffer<T> end_rates_;
  std::vector<Outcome> outcomes_; ///< of the members of an ensemble
};

/// Makes the executor of a module that consists of the row engine.
std::unique_ptr<Executor> create_row_executor(const Setup& setup);

} // namespace dss
