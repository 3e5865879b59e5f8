#include "variants/cost/trial.hpp"

#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <chrono>

namespace dss {
namespace {

/// Exchanges nothing. The halo stays zero, which takes as long to compute as other numbers.
class NoHalo final : public Halo {
public:
  void send(Side, int) override {}
  void receive(Side, int) override {}
};

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A part under one schedule, ready for repeated timing.
class Trial {
public:
  Trial(const Setup& whole, const Plugin& plugin, const Decomposition& decomposition, int index,
        const HaloStrategy& strategy)
      : part_(make_part(whole.problem, decomposition, index,
                        halo_depth(strategy, {whole.method, whole.problem}))),
        part_setup_{part_, halo_, strategy.is_every_stage, strategy.is_overlapped},
        setup_{part_.problem, whole.method, whole.model, whole.precision, whole.dt,
               whole.threads, &part_setup_, nullptr,     whole.device},
        executor_(plugin.create(setup_)),
        work_(element_stages(part_size(whole.problem, decomposition, index, part_.depth), strategy,
                             {whole.method, whole.problem})) {
    steps_ = trial_steps([this](long steps) { return run_s(steps); });
  }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;
  double speed() { return work_ * double(steps_) / run_s(steps_); }

private:
  double run_s(long steps) {
    const std::vector<double> signals =
        signal_rows(part_.problem, setup_.method, setup_.dt, 0, steps);
    const double start = now_s();
    executor_->advance(steps, signals);
    return now_s() - start;
  }
  const Part part_;
  NoHalo halo_;
  const PartSetup part_setup_;
  const Setup setup_;
  const std::unique_ptr<Executor> executor_;
  const double work_;
  long steps_ = 1;
};

} // namespace

NodeSpeed measure_speed(const Setup& setup, const Plugin& plugin,
                        const Decomposition& decomposition, int part, int rounds) {
  const std::size_t elements = setup.problem.lattice.element_count;
  const bool is_large = elements / std::size_t(decomposition.parts) > large_part_elements;
  // A schedule is timed several times in a row: two executors in turn would drive each other's
  // state out of the caches. Two such blocks, so that a disturbance does not meet one schedule
  // alone.
  const int blocks = is_large ? 1 : 2, timings = std::max(1, rounds / 2);
  const auto improve = [&](double& speed, const char* strategy) {
    Trial trial(setup, plugin, decomposition, part, *find_halo_strategy(strategy));
    for (int n = 0; n < timings; ++n) speed = std::max(speed, trial.speed());
  };
  NodeSpeed best;
  for (int block = 0; block < blocks; ++block) {
    improve(best.at_once, "deep");
    improve(best.stage_by_stage, "sendrecv");
  }
  return best;
}

double measure_speed_at_once(const Setup& setup, const Plugin& plugin,
                             const Decomposition& decomposition, int part, int rounds) {
  Trial trial(setup, plugin, decomposition, part, *find_halo_strategy("deep"));
  double best = 0;
  for (int round = 0; round < rounds; ++round) best = std::max(best, trial.speed());
  return best;
}

} // namespace dss
