#include "experiments/studies/chain/stage_run.hpp"
#include "experiments/base/clock.hpp"
#include "kernels/fields.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/oracle.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {

StageRun::StageRun(const ChainStudy& study, const Scene& scene, const ChainStage& stage)
    : scene_(scene), method_(method_of(stage)),
      dt_(study.end_time / double(study.saved_times) / double(stage.steps_an_interval)),
      executor_(
          load_variant(stage.variant)
              .create({scene.problem, method_, stage.model, stage.precision, dt_, stage.threads})),
      end_(stage.steps_an_interval * study.saved_times), start_(state()) {}

void StageRun::advance(long steps) {
  if (done_ > 0 && done_ + steps > end_) {
    executor_->write(0, start_);
    done_ = 0;
  }
  const std::vector<double> signals = signal_rows(scene_.problem, method_, dt_, done_, steps);
  const UsageMeter meter;
  const auto start = Clock::now();
  const Outcome outcome = executor_->advance(steps, signals);
  wall_s_ = seconds_since(start);
  usage_ = meter.read();
  if (!outcome.is_finite)
    throw InputError(fmt::format("chain: {} at dt = {:g} s: {} in step {}", method_.name, dt_,
                                 outcome.what, done_ + outcome.step));
  done_ += steps;
}

std::vector<double> StageRun::state() {
  std::vector<double> fields(scene_.problem.lattice.element_count * field_count);
  executor_->read(0, fields);
  return fields;
}

namespace {

constexpr long oracle_steps = 5; ///< of the solution, which the oracle repeats

/// States at the saved times that the stage reaches in `most_s` seconds, but at least one.
States states_of(const ChainStudy& study, const Scene& scene, const ChainStage& stage,
                 double most_s) {
  StageRun run(study, scene, stage);
  States states;
  double spent_s = 0;
  while (int(states.size()) < study.saved_times && (states.empty() || spent_s < most_s)) {
    run.advance(stage.steps_an_interval);
    spent_s += run.wall_s();
    states.push_back(run.state());
  }
  return states;
}

/// Over the saved times that `states` has.
double largest_error(const States& states, const States& solution) {
  double difference = 0, largest = 0;
  for (std::size_t time = 0; time < states.size(); ++time)
    for (std::size_t k = 0; k < states[time].size(); ++k) {
      if (int(k % field_count) > uz) continue;
      const double error = std::abs(states[time][k] - solution[time][k]);
      if (std::isnan(error)) return error;
      difference = std::max(difference, error);
      largest = std::max(largest, std::abs(solution[time][k]));
    }
  return difference / largest;
}

/// Difference of a run from the oracle's after a few steps.
double difference_from_oracle(const ChainStudy& study, const Scene& scene,
                              const ChainStage& stage) {
  StageRun run(study, scene, stage);
  run.advance(oracle_steps);
  const Method method = method_of(stage);
  Oracle<long double> oracle(scene.problem, method, run.dt(), rotation_of(stage.model));
  oracle.advance(oracle_steps);
  std::vector<double> expected(scene.problem.lattice.element_count * field_count);
  oracle.read(expected);
  return largest_error({run.state()}, {expected});
}

} // namespace

long stable_steps(const ChainStudy& study, const Problem& problem, const ChainStage& stage) {
  const double interval_s = study.end_time / double(study.saved_times);
  const Method method = method_of(stage);
  return long(std::ceil(interval_s / stable_step(problem, method).dt));
}

std::string numerics_of(const ChainStage& stage) {
  return fmt::format("{} {} {} {}", name(stage.model), name(stage.precision), stage.integrator,
                     stage.steps_an_interval);
}

ChainErrors::ChainErrors(const ChainStudy& study, const Scene& scene,
                         std::function<void(const std::string&)> note)
    : study_(study), scene_(scene), note_(std::move(note)),
      solution_(states_of(study, scene, study.solution, INFINITY)) {
  ChainStage coarse = study.solution;
  coarse.steps_an_interval /= 2;
  // The difference of two runs, one with twice the steps of the other, is 2^p - 1 times the error
  // of the finer run; p is the order of the method.
  solution_error_ = largest_error(states_of(study, scene, coarse, INFINITY), solution_) /
                    (std::pow(2.0, find_method(coarse.integrator)->order) - 1);
  oracle_error_ = difference_from_oracle(study, scene, study.solution);
  note_(fmt::format("chain: solution with {} steps, its own error {:.1e}; differs from the oracle "
                    "by {:.1e} after {} steps",
                    study.solution.steps_an_interval * study.saved_times, solution_error_,
                    oracle_error_, oracle_steps));
}

StageError ChainErrors::of(const ChainStage& stage) const {
  const States states = states_of(study_, scene_, stage, study_.error_s);
  const double until_s = study_.end_time * double(states.size()) / study_.saved_times;
  const StageError error{largest_error(states, solution_), until_s};
  note_(fmt::format("chain: {}: error {:.2e} until {:g} s", stage.label, error.largest, until_s));
  return error;
}

} // namespace dss
