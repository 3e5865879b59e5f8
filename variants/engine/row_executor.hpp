#pragma once
/// The executor of every CPU variant: converts states, starts and reads the methods, runs the schedule on a team of
/// threads.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api.hpp"
#include "variants/engine/staged.hpp"

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
  std::string schedule() const override;
  std::size_t bytes() const override;
  int workers() const override { return staged_ ? staged_->threads() : int(blocks_.size()); }

private:
  static constexpr int W = PackedRows<T>::W;
  bool is_leapfrog() const { return setup_.method.family == Method::Family::leapfrog; }
  /// Leapfrog rows of velocity-dependent problems hold half-step velocities behind the model's fields.
  bool is_predicted() const { return is_leapfrog() && packed_.leapfrog_fields > packed_.fields(); }
  int stored_fields() const { return is_leapfrog() ? packed_.leapfrog_fields : packed_.fields(); }
  T* row(int r);
  /// Calls visit(element, lane pointer to the first field) for elements [first, first + count).
  template <class Visit>
  void each_element(std::size_t first, std::size_t count, Visit&& visit);
  /// Rates of all model fields, packs of packed_.fields() fields, at the present state.
  Buffer<T> evaluate(std::span<const double> signals);
  /// Place of velocity and spin components: (index in the model's fields, index among the stored half-step velocities).
  template <class Visit>
  void each_velocity(Visit&& visit) const;
  void start_leapfrog(std::span<const double> signals);
  /// Velocities back from the half step to the present time, so that the state is what read() says.
  void stop_leapfrog();
  void read_synchronised(std::size_t element, const T* lane, std::span<double> out);
  Outcome run_blocks(long steps, std::span<const double> signals);
  Outcome run_staged(long steps, std::span<const double> signals);
  std::size_t first_failed_element(int row);

  const Setup setup_;
  PackedRows<T> packed_;
  std::vector<Block<T>> blocks_;        ///< wavefront
  std::vector<WavefrontStep<T>> steps_; ///< of each block
  std::optional<StagedRows<T>> staged_; ///< or stage by stage
  int parity_ = 0;
  bool is_started_ = false; ///< leapfrog: stored velocities are those of the half step before
  std::vector<double> end_signals_;
  Buffer<T> end_rates_; ///< leapfrog: rates at the end of the last advance, made when first read
};

/// The plug-in record of a module built over this engine.
std::unique_ptr<Executor> create_row_executor(const Setup& setup);

} // namespace dss
