/// Follows the energy of a run, for its balance.
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <utility>

namespace dss {
bool TimedRun::is_balanced_by_steps() const {
  // With adaptive steps, the number of steps is known at the end.
  const long steps = plan_.adaptive ? result_.steps : plan_.steps;
  // Leaps of other lengths have other bits.
  return !plan_.method->has_leaps() &&
         dss::is_balanced_by_steps(problem_.lattice.element_count, steps);
}

long TimedRun::balance_interval() const {
  if (!has_looks_at_energy_) return 0;
  return energy_look_interval(problem_.lattice.element_count, plan_.steps);
}

void TimedRun::begin_balance(long step, const std::vector<double>* state) {
  balance_.reset();
  balance_start_.reset();
  has_looks_at_energy_ = false;
  if (!has_energy_balance(plan_, request_, equations())) return;
  has_looks_at_energy_ = !plan_.adaptive && !is_balanced_by_steps();
  balance_start_ = {state != nullptr ? *state : initial_state(problem_), step};
  if (plan_.adaptive || !is_balanced_by_steps())
    balance_.emplace(problem_, equations(), balance_start_->state, double(step) * plan_.dt, false);
}

void TimedRun::look_at_energy(EnergyBalance& balance, double time) {
  const std::vector<double> state = whole_state(*executor_, problem_.lattice.element_count);
  const WorkAlone alone(*executor_, is_root_);
  if (is_root_) balance.look(state, time);
}

bool TimedRun::repeat_by_steps(EnergyBalance& balance) {
  const auto& [state, start] = *balance_start_;
  executor_->write(0, state);
  if (plan_.adaptive) {
    AdaptiveSteps adaptive = adaptive_steps();
    adaptive.visit_accepted([&](double time) { look_at_energy(balance, time); });
    return std::ranges::all_of(
        stops(), [&](long stop) { return !adaptive.advance_to(double(stop) * plan_.dt); });
  }
  for (long step = start; step < plan_.steps; ++step) {
    if (!executor_->advance(1, signal_rows(problem_, *plan_.method, plan_.dt, step, 1)).is_finite)
      return false;
    look_at_energy(balance, double(step + 1) * plan_.dt);
  }
  return true;
}

EnergyShares TimedRun::balance_by_steps() {
  // Steps without a limit may be too long for the rule of what dampers take.
  EnergyBalance balance(problem_, equations(), balance_start_->state,
                        double(balance_start_->step) * plan_.dt, !plan_.method->is_unlimited());
  const bool is_finite = repeat_by_steps(balance);
  if (!is_finite ||
      state_digest(*executor_, problem_.lattice.element_count, plan_.precision) != result_.digest) {
    result_.status = "wrong";
    result_.reason = "the bits of a second run, step by step, are not those of the first";
  }
  return balance.shares();
}

std::optional<EnergyShares> TimedRun::energy_balance() {
  if (!balance_start_) return {};
  std::optional<EnergyShares> shares;
  if (is_balanced_by_steps()) {
    shares = balance_by_steps();
  } else {
    look_at_energy(*balance_, double(plan_.steps) * plan_.dt);
    shares = balance_->shares();
  }
  return is_root_ ? shares : std::nullopt;
}

} // namespace dss
