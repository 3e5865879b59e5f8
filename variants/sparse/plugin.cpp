/// The variant `sparse`: implicit methods, with the factors of a sparse matrix.
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"
#include "solver/statics/factors.hpp"
#include "variants/api/api.hpp"
#include "variants/sparse/implicit_step.hpp"
#include "variants/sparse/linear_stages.hpp"
#include "variants/sparse/nonlinear_stages.hpp"

#include <cmath>

namespace dss {
namespace {

/// Other variants, for their parts and members, do not ask first.
const Setup& required(const Setup& setup) {
  if (setup.part != nullptr || setup.ensemble != nullptr || !setup.method.is_implicit() ||
      setup.precision != Precision::f64)
    throw InputError("variant sparse has whole problems, the implicit methods and f64 alone; give "
                     "another --variant");
  return setup;
}

std::unique_ptr<Stages> stages_of(const Setup& setup) {
  const double share = implicit_share(setup.method) * setup.dt;
  if (is_linear(setup.model))
    return std::make_unique<LinearStages>(setup.problem, setup.model, share);
  return std::make_unique<NonlinearStages>(setup.problem, setup.model, rotation_of(setup.model),
                                           share);
}

class SparseExecutor final : public Executor, public MatrixFactors {
public:
  explicit SparseExecutor(const Setup& setup)
      : setup_(required(setup)), stages_(stages_of(setup)),
        step_(setup.method, setup.dt, *stages_) {
    const std::vector<double> rest(setup.problem.lattice.element_count * field_count, 0);
    stages_->write(0, rest, state_);
  }

  void write(std::size_t first, std::span<const double> fields) override {
    stages_->write(first, fields, state_);
    step_.restart();
  }
  void read(std::size_t first, std::span<double> fields) override {
    stages_->read(first, fields, state_);
  }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    Oracle<double> oracle(setup_.problem, methods().front(), setup_.dt, rotation_of(setup_.model));
    std::vector<double> fields(setup_.problem.lattice.element_count * field_count);
    read(0, fields);
    oracle.write(fields);
    oracle.derivative(signals, rates);
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    const std::size_t rows = signal_count(setup_.problem) * std::size_t(setup_.method.stages);
    for (long step = 0; step < steps; ++step) {
      if (const auto element =
              step_.advance(state_, signals.subspan(std::size_t(step) * rows, rows)))
        return {false, step, *element, "Newton's iteration finds no state"};
      if (!std::isfinite(state_.sum()))
        return {false, step, stages_->element_of(first_not_finite(state_))};
    }
    return {true, steps, 0};
  }
  std::string schedule() const override { return stages_->text(); }
  int workers() const override { return 1; }
  std::size_t bytes() const override {
    const auto columns = double(setup_.method.stages + 2);
    return std::size_t(stages_->bytes() + columns * sizeof(double) * double(state_.size()));
  }
  MatrixFactors* matrix_factors() override { return this; }
  FactorInfo factor_info() const override { return stages_->factor_info(); }

private:
  const Setup setup_;
  std::unique_ptr<Stages> stages_;
  ImplicitStep step_;
  Stages::Vector state_;
};

std::unique_ptr<Executor> create(const Setup& setup) {
  return std::make_unique<SparseExecutor>(setup);
}

constexpr Plugin plugin = {.abi = plugin_abi,
                           .name = DSS_VARIANT,
                           .isa = DSS_ISA,
                           .has_fma = false,
                           .is_threaded = false,
                           .is_distributed = false,
                           .create = create,
                           .kernels = nullptr,
                           .why_unusable = why_no_factors,
                           .is_compensated = false,
                           .is_implicit = true,
                           .has_pressure = true,
                           .has_mass_ratios = true};

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() { return &dss::plugin; }
