/// The variant `wider`: computes every problem in wider numbers than asked for, double for f32 and
/// long double for f64. Its difference to other variants is their rounding error. The oracle of the
/// solver's library computes here; in a variant of your own, your code does.
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"
#include "variants/api/tried_steps.hpp"

namespace {

template <class T>
class WiderExecutor final : public dss::Executor, public dss::StepTrials {
public:
  explicit WiderExecutor(const dss::Setup& setup)
      : setup_(setup), oracle_(setup.problem, setup.method, setup.dt, rotation_of(setup.model)),
        row_width_(dss::signal_count(setup.problem)), stages_(setup.method.stages) {}

  void write(std::size_t first, std::span<const double> fields) override {
    oracle_.write(fields, first);
  }
  void read(std::size_t first, std::span<double> fields) override { oracle_.read(fields, first); }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    oracle_.derivative(signals, rates);
  }
  dss::Outcome advance(long steps, std::span<const double> signals) override {
    if (setup_.method.has_error_stage) return advance_by_tries(*this, setup_, steps, signals);
    const auto breakdown = oracle_.advance(steps, [&](long step, int stage) {
      return signals.subspan(std::size_t(step * stages_ + stage) * row_width_, row_width_);
    });
    if (breakdown) return {false, breakdown->step, breakdown->element, breakdown->what};
    return {true, steps, 0};
  }
  dss::StepTrials* step_trials() override { return this; }
  dss::StepMaxima try_step(double dt, std::span<const double> signals) override {
    return oracle_.try_step(dt, signals);
  }
  void accept_step() override { oracle_.accept_step(); }
  std::string schedule() const override { return "stage by stage, in wider numbers"; }
  int workers() const override { return 1; }
  std::size_t bytes() const override { return oracle_.bytes(); }

private:
  const dss::Setup setup_;
  dss::Oracle<T> oracle_;
  std::size_t row_width_;
  long stages_;
};

std::unique_ptr<dss::Executor> create(const dss::Setup& setup) {
  if (setup.precision == dss::Precision::f32) return std::make_unique<WiderExecutor<double>>(setup);
  return std::make_unique<WiderExecutor<long double>>(setup);
}

constexpr dss::Plugin plugin = {.abi = dss::plugin_abi,
                                .name = DSS_VARIANT,
                                .isa = DSS_ISA,
                                .has_fma = false,
                                .is_threaded = false,
                                .is_distributed = false,
                                .create = create,
                                .kernels = nullptr,
                                .is_compensated = false,
                                // The oracle has them; leave this out if your code has not.
                                .has_pressure = true};

} // namespace

extern "C" const dss::Plugin* dss_plugin() { return &plugin; }
