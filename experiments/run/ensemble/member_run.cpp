#include "experiments/run/ensemble/member_run.hpp"

#include "experiments/run/state/state_access.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>

namespace dss {

MemberRun::MemberRun(const RunPlan& plan, const RunRequest& request)
    : plan_(plan), request_(request), result_(described(plan, request)),
      series_(request.is_root ? request.output : "", plan.frame_steps.size() > 1, outputs_),
      oracle_check_(plan) {
  if (request.is_root && !request.history.empty())
    history_.emplace(request.history, plan.scene.problem, plan.probes);
}

std::uint64_t MemberRun::digest_of(std::span<const double> state) const {
  StateDigest digest(plan_.precision);
  digest.add(state);
  return digest.value();
}

void MemberRun::guarded(const std::function<void()>& act) {
  try {
    act();
  } catch (const UnstableError& error) {
    result_.status = "unstable";
    result_.reason = error.what();
  }
  if (!is_ok()) series_.discard();
}

void MemberRun::look(std::span<const double> state, long step) {
  const Problem& problem = plan_.scene.problem;
  const double time = double(step) * plan_.dt;
  const long between = energy_look_interval(problem.lattice.element_count, plan_.steps);
  const bool is_due = step % between == 0;
  if (balance_ && (is_due || step == plan_.steps))
    balance_->look(state, time);
  else if (has_balance() && is_due && step < plan_.steps) // the balance of a continued run begins
    balance_.emplace(problem, equations(), state, time, false);
  if (oracle_check_.is_wanted(step)) oracle_check_.look(step, state, equations(), result_.check);
  const bool has_frame = std::ranges::binary_search(plan_.frame_steps, step),
             has_row = history_ && std::ranges::binary_search(plan_.history_steps, step);
  if (!has_frame && !has_row) return;
  guarded([&] {
    const std::vector<double> signals = signals_at(problem, time);
    if (has_frame) series_.add(problem, {state.begin(), state.end()}, equations(), signals, time);
    if (has_row) history_->add(step, time, state, equations(), signals), history_->release();
  });
}

void MemberRun::resume(const MemberStanding& standing) {
  result_.resumed_step = standing.step;
  if (const auto& failure = standing.failure) {
    result_.status = "unstable";
    result_.reason = failure->reason;
    result_.steps = result_.resumed_step = failure->steps;
    return;
  }
  std::vector<double> times;
  for (const long frame : plan_.frame_steps)
    if (frame <= standing.step) times.push_back(double(frame) * plan_.dt);
  if (request_.is_root && !request_.output.empty()) series_.go_on(times);
  if (history_) history_->go_on(standing.history);
}

void MemberRun::fail(const Outcome& failure) {
  guarded([&] {
    result_.steps = failure.step + 1;
    throw UnstableError(breakdown_reason(plan_, failure, failure.step));
  });
}

void MemberRun::end(std::span<const double> state) {
  const std::vector<double> copy(state.begin(), state.end());
  guarded([&] {
    result_.max_displacement_m = max_displacement(state);
    result_.digest = digest_of(state);
    if (plan_.scene.problem.lattice.element_count <= energy_elements)
      describe_state(plan_, equations(), copy, result_);
    judge_range(plan_, equations(), result_);
    if (!is_ok()) return;
    if (request_.is_root)
      write_final_files(outputs_, request_, plan_.scene.problem, copy, equations(),
                        signals_at(plan_.scene.problem, result_.end_s));
    for (const std::string& file : final_files(request_)) result_.files.push_back(file);
    if (const std::string written = series_.finish(); !written.empty())
      result_.files.push_back(written);
    if (!request_.history.empty()) result_.files.push_back(request_.history);
    if (history_) history_->write(outputs_);
    outputs_.commit();
  });
  if (is_ok() && balance_) result_.balance = balance_->shares();
}

void MemberRun::begin_steps() {
  balance_.emplace(plan_.scene.problem, equations(), initial_state(plan_.scene.problem), 0.0,
                   !plan_.method->is_unlimited());
}

void MemberRun::look_at_step(std::span<const double> state, long step) {
  balance_->look(state, double(step) * plan_.dt);
  if (step == plan_.steps) result_.balance = balance_->shares();
}

void MemberRun::judge(std::span<const double> last) {
  judge_check(result_);
  judge_energy(plan_, result_);
  if (!is_ok() || digest_of(last) == result_.digest) return;
  result_.status = "wrong";
  result_.reason = "the bits of a later run from the same state are not those of the first";
}

} // namespace dss
