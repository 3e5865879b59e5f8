#pragma once
/// The executor of every CPU variant: converts states, starts and reads the methods, runs the schedule on a team of
/// threads.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api.hpp"
#include "variants/engine/blocks.hpp"
#include "variants/engine/staged.hpp"
#include "variants/engine/state_rows.hpp"

#include <optional>

namespace dss {

template <class T>
class RowExecutor final : public Executor {
public:
  explicit RowExecutor(const Setup& setup);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
  StepMaxima try_step(double dt, std::span<const double> signals) override;
  void accept_step() override;
  std::string schedule() const override;
  std::size_t bytes() const override;
  int workers() const override { return staged_ ? staged_->threads() : threads_; }
  int halo_copies() const override { return staged_ ? staged_->copies() : 2; }
  HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) override;
  int halo_lanes() const override { return W; }
  int kept_fields() const override { return rows_.kept_fields(); }
  void save(std::size_t first, std::span<double> kept) override;
  void restore(std::size_t first, std::span<const double> kept) override;

private:
  static constexpr int W = simd::lanes<T>;
  int stored_fields() const { return rows_.stored_fields(); }
  bool is_part() const { return part_ != nullptr; }
  void make_blocks();
  T* row(int r);
  /// Row of a copy that parts exchange, and where else it is kept (or null).
  std::pair<T*, T*> copy_row(int copy, int r);
  int current_copy() const { return staged_ ? staged_->current_copy() : parity_; }
  void exchange(void (Halo::*act)(Side, int), int copy) {
    for (const Side side : all_sides) (part_->halo.*act)(side, copy);
  }
  /// All of the halo anew, of the present state. Every part must take part.
  void refresh_halo();
  /// Rates of all model fields, packs of packed_.fields() fields, at the present state.
  Buffer<T> evaluate(std::span<const double> signals);
  void start_leapfrog(std::span<const double> signals);
  /// Velocities back from the half step to the present time, so that the state is what read() says.
  void stop_leapfrog();
  Outcome run_blocks(long steps, std::span<const double> signals);
  /// One step of a part by one thread, which sends as early and receives as late as it can.
  void step_overlapped(const double* signals, int parity, bool is_last);
  Outcome run_staged(long steps, std::span<const double> signals);

  const Setup setup_;
  const PartSetup* part_; ///< null for a whole problem, or a part that has no neighbours
  PackedRows<T> packed_;
  StateRows<T> rows_;
  Blocks<T> blocks_;                    ///< wavefront
  std::vector<WavefrontStep<T>> steps_; ///< of each own block
  int threads_ = 1, steps_a_pass_ = 1;
  std::optional<StagedRows<T>> staged_; ///< or stage by stage
  int parity_ = 0;
  bool is_started_ = false; ///< leapfrog: stored velocities are those of the half step before
  std::vector<double> end_signals_;
  Buffer<T> end_rates_; ///< leapfrog: rates at the end of the last advance, made when first read
};

/// The plug-in record of a module built over this engine.
std::unique_ptr<Executor> create_row_executor(const Setup& setup);

} // namespace dss
