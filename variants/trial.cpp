#include "variants/trial.hpp"

#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

namespace dss {
namespace {

constexpr double trial_s = 5e-3; ///< of each of a few timings
constexpr int trials = 4;

class NoHalo final : public Halo {
public:
  void send(Side, int) override {}
  void receive(Side, int) override {}
};

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

} // namespace

double measure_step_s(const Setup& setup, const Plugin& plugin, const Part& part, const HaloStrategy& strategy) {
  NoHalo halo;
  const PartSetup part_setup{part, halo, strategy.is_every_stage, strategy.is_overlapped};
  const auto executor =
      plugin.create({part.problem, setup.method, setup.model, setup.precision, setup.dt, setup.threads, &part_setup});
  const auto run_s = [&](long steps) {
    const std::vector<double> signals = signal_rows(part.problem, setup.method, setup.dt, 0, steps);
    const double start = now_s();
    executor->advance(steps, signals);
    return now_s() - start;
  };
  long steps = 1;
  while (run_s(steps) < trial_s && steps < 1 << 16) steps *= 2;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < trials; ++n) least = std::min(least, run_s(steps) / double(steps));
  return least;
}

} // namespace dss
