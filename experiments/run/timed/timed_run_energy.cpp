/// Follows the energy of a run, for its balance.
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <utility>

namespace dss {
namespace {

/// Larger scenes have no balance: it holds the state several times.
constexpr std::size_t balanced_elements = 250'000;
/// Runs of at most this many element-steps are computed once more with a look at each step, some
/// 1 us an element.
constexpr double looked_at_by_steps = 1.2e6;
/// Looks on the way in other runs: at most this many, and in all this many elements.
constexpr long most_energy_looks = 16;
constexpr long most_looked_at = 2'000'000;

bool has_constant_signals(const Problem& problem) {
  const auto is_constant = [](const Signal& signal) {
    return signal.kind == Signal::Kind::constant || is_zero_always(signal);
  };
  return std::ranges::all_of(problem.frame_acceleration, is_constant) &&
         std::ranges::all_of(problem.loads,
                             [&](const Load& load) { return is_constant(load.signal); });
}

} // namespace

bool TimedRun::is_balanced_by_steps() const {
  // With adaptive steps, the number of steps is known at the end.
  const double steps = double(plan_.adaptive ? result_.steps : plan_.steps);
  return double(problem_.lattice.element_count) * steps <= looked_at_by_steps;
}

long TimedRun::balance_interval() const {
  if (!balance_ || plan_.adaptive || has_constant_signals(problem_)) return 0;
  const auto count = long(problem_.lattice.element_count);
  const long looks = std::clamp(most_looked_at / count, 1L, most_energy_looks);
  const long chunks = (plan_.steps + looks * signal_steps - 1) / (looks * signal_steps);
  return std::max(1L, chunks) * signal_steps;
}

void TimedRun::begin_balance(std::vector<double> state, long step) {
  // Errors against a solution say more.
  if (plan_.reference || problem_.lattice.element_count > balanced_elements) return;
  balance_.reset();
  if (plan_.adaptive || !is_balanced_by_steps())
    balance_.emplace(problem_, equations(), state, double(step) * plan_.dt, false);
  balance_start_ = {std::move(state), step};
}

void TimedRun::look_at_energy(EnergyBalance& balance, double time) {
  const std::vector<double> state = whole_state(*executor_, problem_.lattice.element_count);
  const WorkAlone alone(*executor_, is_root_);
  if (is_root_) balance.look(state, time);
}

EnergyShares TimedRun::balance_by_steps() {
  const auto& [state, start] = *balance_start_;
  // Steps of implicit methods may be too long for the rule of what dampers take.
  EnergyBalance balance(problem_, equations(), state, double(start) * plan_.dt,
                        !plan_.method->is_implicit());
  executor_->write(0, state);
  if (plan_.adaptive) {
    AdaptiveSteps adaptive = adaptive_steps();
    adaptive.visit_accepted([&](double time) { look_at_energy(balance, time); });
    for (const long stop : stops()) adaptive.advance_to(double(stop) * plan_.dt);
    return balance.shares();
  }
  for (long step = start; step < plan_.steps; ++step) {
    executor_->advance(1, signal_rows(problem_, *plan_.method, plan_.dt, step, 1));
    look_at_energy(balance, double(step + 1) * plan_.dt);
  }
  return balance.shares();
}

std::optional<EnergyShares> TimedRun::energy_balance() {
  if (!balance_start_) return {};
  if (is_balanced_by_steps()) return balance_by_steps();
  look_at_energy(*balance_, double(plan_.steps) * plan_.dt);
  return balance_->shares();
}

} // namespace dss
