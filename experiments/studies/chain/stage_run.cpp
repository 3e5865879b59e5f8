#include "experiments/studies/chain/stage_run.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/base/cores.hpp"
#include "kernels/fields.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {

StageRun::StageRun(const ChainStudy& study, const Scene& scene, const ChainStage& stage)
    : scene_(scene), method_(*find_method(stage.integrator)),
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

static States states_of(const ChainStudy& study, const Scene& scene, ChainStage stage) {
  stage.variant = load_variant("auto").name;
  stage.threads = usable_cores();
  StageRun run(study, scene, stage);
  States states;
  for (int time = 0; time < study.saved_times; ++time) {
    run.advance(stage.steps_an_interval);
    states.push_back(run.state());
  }
  return states;
}

static double largest_error(const States& states, const States& solution) {
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

std::string numerics_of(const ChainStage& stage) {
  return fmt::format("{} {} {} {}", name(stage.model), name(stage.precision), stage.integrator,
                     stage.steps_an_interval);
}

ChainErrors::ChainErrors(const ChainStudy& study, const Scene& scene,
                         std::function<void(const std::string&)> note)
    : study_(study), scene_(scene), note_(std::move(note)),
      solution_(states_of(study, scene, study.solution)) {
  ChainStage coarse = study.solution;
  coarse.steps_an_interval /= 2;
  // The difference of two runs, one with twice the steps of the other, is 2^p - 1 times the error
  // of the finer run; p is the order of the method.
  solution_error_ = largest_error(states_of(study, scene, coarse), solution_) /
                    (std::pow(2.0, find_method(coarse.integrator)->order) - 1);
  note_(fmt::format("chain: solution with {} steps, its own error {:.1e}",
                    study.solution.steps_an_interval * study.saved_times, solution_error_));
}

double ChainErrors::of(const ChainStage& stage) {
  const auto [place, is_new] = errors_.try_emplace(numerics_of(stage));
  if (is_new) {
    place->second = largest_error(states_of(study_, scene_, stage), solution_);
    note_(fmt::format("chain: {}: error {:.2e}", place->first, place->second));
  }
  return place->second;
}

} // namespace dss
