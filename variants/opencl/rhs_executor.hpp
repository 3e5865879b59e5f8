#pragma once
/// The executor of the variant `opencl-rhs`: the paper's first use of a GPU. The device computes
/// only the right-hand side. In every stage the state goes there, and the rates come back.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api/api.hpp"
#include "variants/engine/state_rows.hpp"
#include "variants/engine/step_error.hpp"
#include "variants/engine/wavefront.hpp"
#include "variants/opencl/device_rates.hpp"

namespace dss::opencl {

/// Computes a problem with the right-hand side on a device, in packs of W lanes of T.
template <class T, int W>
class RhsExecutor final : public Executor, public StepTrials, public DeviceWork {
public:
  RhsExecutor(const Setup& setup, const Device& device, const Layout& layout);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
  StepTrials* step_trials() override { return this; }
  DeviceWork* device_work() override { return this; }
  StepMaxima try_step(double dt, std::span<const double> signals) override;
  void accept_step() override;
  std::string schedule() const override;
  int workers() const override { return rates_.bands(); }
  std::size_t bytes() const override;
  DeviceUse device_use() const override;

private:
  T* row_of(dss::Buffer<T>& rows, int r);
  T* row(int r) { return row_of(state_, r); }
  T* stage_row(int stage, int r) { return row_of(stages_[std::size_t(stage)], r); }
  /// Evaluates plain rows into sums_: the sums over links that the device leaves.
  void evaluate(const T* plain, std::span<const double> signals) {
    rates_.evaluate(plain, signals, sums_.data());
  }
  /// Rates of the state itself.
  std::vector<T> scaled_rates(std::span<const double> signals);
  void stop_leapfrog();
  /// Updates all rows after a stage.
  /// @return the first row that the update leaves with a non-finite velocity, or -1
  template <class Physics>
  int update_stage(int stage);
  template <class Update>
  int each_row(Update&& update);
  /// Computes one step.
  /// @return as update_stage
  int step(std::span<const double> signals);

  const Setup setup_;
  DeviceRates<T, W> rates_;
  const PackedRows<T, W>& packed_ = rates_.device().packed;
  StateRows<T, W> rows_;
  dss::Buffer<T> state_, plain_, sums_;
  /// Output of all stages but the last; with a method with an error stage also of the last.
  std::vector<dss::Buffer<T>> stages_;
  T step_ = 1; ///< length of a step, for methods with an error stage [s]
  /// Lanes of own elements in each pack; only for methods with an error stage.
  std::vector<simd::LaneMask> own_lanes_;
  const std::vector<StageUpdate<T>> updates_;
  bool is_started_ = false;
  std::vector<double> end_signals_;
  std::vector<T> end_rates_;
};

} // namespace dss::opencl
