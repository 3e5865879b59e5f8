/// The variants `reference` and `as_published`: the oracle behind the interface of variants.
/// Straightforward code, one thread, no SIMD by hand. They differ in DSS_ROTATION.
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"
#include "variants/api/tried_steps.hpp"

namespace dss {
namespace {

constexpr Rotation own_rotation = Rotation::DSS_ROTATION;

/// Models with fewer degrees of freedom run the equations of the larger model. Where they suffice,
/// the other fields stay zero.
Rotation rotation_of(const Setup& setup) {
  if (setup.rotation != Rotation::quaternion) return setup.rotation;
  const Rotation of_model = dss::rotation_of(setup.model);
  return of_model == Rotation::quaternion ? own_rotation : of_model;
}

template <class T>
class ReferenceExecutor final : public Executor, public StepTrials {
public:
  explicit ReferenceExecutor(const Setup& setup)
      : setup_(setup), oracle_(setup.problem, setup.method, setup.dt, rotation_of(setup)),
        row_width_(signal_count(setup.problem)), stages_(setup.method.stages) {}

  void write(std::size_t first, std::span<const double> fields) override {
    oracle_.write(fields, first);
  }
  void read(std::size_t first, std::span<double> fields) override { oracle_.read(fields, first); }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    oracle_.derivative(signals, rates);
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    if (setup_.method.has_error_stage) return advance_by_tries(*this, setup_, steps, signals);
    const auto breakdown = oracle_.advance(steps, [&](long step, int stage) {
      return signals.subspan(std::size_t(step * stages_ + stage) * row_width_, row_width_);
    });
    if (breakdown) return {false, breakdown->step, breakdown->element, breakdown->what};
    return {true, steps, 0};
  }
  StepTrials* step_trials() override { return this; }
  StepMaxima try_step(double dt, std::span<const double> signals) override {
    return oracle_.try_step(dt, signals);
  }
  void accept_step() override { oracle_.accept_step(); }
  std::string schedule() const override { return "stage by stage: straightforward code"; }
  int workers() const override { return 1; }
  std::size_t bytes() const override { return oracle_.bytes(); }

private:
  const Setup setup_;
  Oracle<T> oracle_;
  std::size_t row_width_;
  long stages_;
};

std::unique_ptr<Executor> create(const Setup& setup) {
  if (setup.precision == Precision::f32) return std::make_unique<ReferenceExecutor<float>>(setup);
  return std::make_unique<ReferenceExecutor<double>>(setup);
}

constexpr Plugin plugin = {.abi = plugin_abi,
                           .name = DSS_VARIANT,
                           .isa = DSS_ISA,
                           .has_fma = false,
                           .is_threaded = false,
                           .is_distributed = false,
                           .create = create,
                           .kernels = nullptr,
                           .is_compensated = false,
                           .has_all = true,
                           .has_pressure = true,
                           .has_rotating_frame = true,
                           .has_mass_ratios = true,
                           .rotation = own_rotation};

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() { return &dss::plugin; }
