#pragma once
/// The variant `opencl-rhs`, as the paper first used a GPU: the device computes the right-hand side alone, and the state goes there and
/// the rates come back in every stage.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api.hpp"
#include "variants/engine/state_rows.hpp"
#include "variants/engine/step_error.hpp"
#include "variants/engine/wavefront.hpp"
#include "variants/opencl/device_rates.hpp"

namespace dss::opencl {

template <class T, int W>
class RhsExecutor final : public Executor {
public:
  RhsExecutor(const Setup& setup, const Device& device, const Layout& layout);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
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
  /// Sums over the links, as the device leaves them, of plain rows.
  void evaluate(const T* plain, std::span<const double> signals) { rates_.evaluate(plain, signals, sums_.data()); }
  /// Rates of the state itself.
  std::vector<T> scaled_rates(std::span<const double> signals);
  void stop_leapfrog();
  /// The first row that the update leaves with a velocity that is not finite, or -1.
  template <class Physics>
  int update_stage(int stage);
  template <class Update>
  int each_row(Update&& update);
  /// One step; as update_stage.
  int step(std::span<const double> signals);

  const Setup setup_;
  DeviceRates<T, W> rates_;
  const PackedRows<T, W>& packed_ = rates_.device().packed;
  StateRows<T, W> rows_;
  dss::Buffer<T> state_, plain_, sums_;
  std::vector<dss::Buffer<T>>
      stages_; ///< output of all stages but the last; of a method with an error stage also of that
  T step_ = 1; ///< of such a method
  std::vector<simd::LaneMask> own_lanes_; ///< the same: of each pack
  const std::vector<StageUpdate<T>> updates_;
  bool is_started_ = false;
  std::vector<double> end_signals_;
  std::vector<T> end_rates_;
};

} // namespace dss::opencl
