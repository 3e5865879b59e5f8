#include "experiments/run/advise/workbench.hpp"
#include "experiments/run/advise/first_steps.hpp"
#include "experiments/run/timed/adaptive_steps.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "variants/isa/denormals.hpp"
#include "variants/leaps/leap_executor.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace dss {

/// An executor, and the clock that measures its steps.
class Workbench::Process {
public:
  Process(const Workbench& bench, const Configuration& configuration)
      : bench_(bench), configuration_(configuration), dt_(bench.dt(configuration)),
        method_(bench.method_of(configuration)),
        executor_(make_executor(load_variant(configuration.variant),
                                {bench.problem_, method_, configuration.model,
                                 configuration.precision, dt_, configuration.threads, nullptr,
                                 nullptr, "", "", Rotation::quaternion})) {}

  /// Runs from the initial state through all saved times. @param observed  may be null
  void run(Observed* observed) {
    write_initial_state(*executor_, bench_.problem_);
    if (configuration_.rtol) return adapt(observed);
    const long between = configuration_.steps_between;
    for (long k = 0; k < bench_.times_.count; ++k) {
      if (!advance(k * between, between)) return;
      if (observed != nullptr && !look(double(k + 1) * bench_.times_.interval(), *observed)) return;
    }
  }

  bool advance(long step, long count) {
    constexpr long batch = 256; // as signal_steps in timed_run.cpp
    for (const long stop = step + count; step < stop;) {
      const long some = std::min(batch, stop - step);
      const std::vector<double> signals = signal_rows(bench_.problem_, method_, dt_, step, some);
      const double began_s = now_s();
      const Outcome outcome = executor_->advance(some, signals);
      wall_s += now_s() - began_s;
      if (!outcome.is_finite) {
        failure = breakdown_text(outcome.what, step + outcome.step, dt_, outcome.element);
        return false;
      }
      step += some;
      steps += some;
    }
    return true;
  }

  void restart() { write_initial_state(*executor_, bench_.problem_); }

  int workers() const { return executor_->workers(); }

  double wall_s = 0;
  long steps = 0;
  std::string failure;

private:
  static double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  void adapt(Observed* observed) {
    AdaptiveSteps adaptive(*executor_, bench_.problem_, method_, {*configuration_.rtol, 0}, dt_,
                           bench_.times_.end);
    for (long k = 1; k <= bench_.times_.count && failure.empty(); ++k) {
      const double time = double(k) * bench_.times_.interval();
      failure = adaptive.advance_to(time).value_or("");
      if (failure.empty() && observed != nullptr) look(time, *observed);
    }
    wall_s += adaptive.counts().wall_s;
    steps += adaptive.counts().accepted;
  }

  bool look(double time, Observed& observed) {
    const std::vector<double> state =
        whole_state(*executor_, bench_.problem_.lattice.element_count);
    if (std::ranges::all_of(state, [](double value) { return std::isfinite(value); })) {
      observe(bench_.problem_, bench_.quantity_, configuration_.model, state, time, observed);
      return true;
    }
    failure = fmt::format("the state is not finite after {} steps", steps);
    return false;
  }

  const Workbench& bench_;
  const Configuration configuration_;
  const double dt_;
  const Method method_;
  std::unique_ptr<Executor> executor_;
};

const Method& Workbench::fitted_method(const Configuration& of) const {
  const auto [place, is_new] = fitted_.try_emplace({of.method->name, of.steps_between}, *of.method);
  if (is_new)
    place->second = fitted_or_none(problem_, *of.method, dt(of), of.steps_between * times_.count);
  return place->second;
}

Method Workbench::method_of(const Configuration& of) const {
  if (of.rtol) return dopri5_adaptive();
  return of.method->is_fitted() ? fitted_method(of) : *of.method;
}

int Workbench::stages(const Configuration& of) const {
  if (of.rtol) return dopri5_adaptive().stages;
  return of.method->is_fitted() ? fitted_method(of).stages : of.method->stages;
}

Observation Workbench::run(const Configuration& configuration) const {
  const FlushDenormals flush;
  Observation observation;
  if (stages(configuration) == 0) {
    observation.failure = "no number of stages would do with that step";
    return observation;
  }
  Process process(*this, configuration);
  process.run(&observation.observed);
  observation.wall_s = process.wall_s;
  observation.steps = process.steps;
  observation.failure = process.failure;
  return observation;
}

int Workbench::workers(const Configuration& configuration) const {
  return Process(*this, configuration).workers();
}

double Workbench::step_time(const Configuration& configuration, double least_s) const {
  const FlushDenormals flush;
  Process process(*this, configuration);
  const auto timed = [&](long count) {
    process.restart();
    process.wall_s = 0;
    process.advance(0, count);
    return process.wall_s;
  };
  timed(1); // warm-up
  long count = 1;
  double best_s = timed(count);
  while (best_s < least_s && process.failure.empty()) {
    count =
        std::max(count + 1, long(double(count) * std::clamp(1.2 * least_s / best_s, 1.0, 64.0)));
    best_s = timed(count);
  }
  const int more = best_s > 20 * least_s ? 0 : 2; // one timing of a long step is accurate enough
  for (int round = 0; round < more && process.failure.empty(); ++round)
    best_s = std::min(best_s, timed(count));
  return process.failure.empty() ? best_s / double(count) : std::numeric_limits<double>::infinity();
}

double Workbench::run_time(const Configuration& configuration, double least_s) const {
  const FlushDenormals flush;
  Process process(*this, configuration);
  long runs = 0;
  do {
    process.run(nullptr);
    ++runs;
  } while (process.wall_s < least_s && process.failure.empty());
  return process.failure.empty() ? process.wall_s / double(runs)
                                 : std::numeric_limits<double>::infinity();
}

} // namespace dss
