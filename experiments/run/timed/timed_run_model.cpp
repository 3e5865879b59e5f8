/// Watches a run with a model of small rotations, and acts if the model's error may exceed its
/// tolerance.
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/timed_run.hpp"

#include <fmt/format.h>
#include <utility>

namespace dss {

bool TimedRun::advance_watched(long step, long stop) {
  while (step < stop) {
    if (!monitor_) return advance_to(step, stop, result_);
    // A continued run may begin between two looks.
    const long next = monitor_->next_look(monitor_->good_step(), stop);
    RunResult tried = result_;
    const bool is_finite = advance_to(step, next, tried);
    result_.wall_s = tried.wall_s, result_.usage = tried.usage, result_.guard = tried.guard;
    if (is_finite && monitor_->look(*executor_, next)) {
      step = next;
      result_.model_report = monitor_->report();
      continue;
    }
    if (tried.status == "faulty" || (!is_finite && request_.on_bound == "stop")) {
      // with --on-bound stop, a non-finite state is reported as unstable
      result_ = std::move(tried);
      return false;
    }
    step = monitor_->good_step();
    if (guard_ && is_finite &&
        !is_sound(guard_->go_back(*executor_, step, monitor_->good_state(), next), next, result_))
      return false;
    if (guard_) guard_->forget();
    if (!promote(next, step, monitor_->promoted(), "")) return false;
  }
  return true;
}

void TimedRun::stop_at_bound(const Promotion& promotion, const std::string& relative_to) {
  result_.status = "bound";
  const std::string error =
      relative_to.empty()
          ? fmt::format("{:.3g}, above {:g} of the tolerance {:g}", promotion.estimate,
                        bounded_share, monitor_->tolerance())
          : fmt::format("above the tolerance {:g} {}", monitor_->tolerance(), relative_to);
  result_.reason = fmt::format(
      "after step {} (t = {:g} s) the error of model {} may be {}; take --model {}, or "
      "--on-bound promote",
      promotion.step, double(promotion.step) * plan_.dt, name(model_), error, name(promotion.to));
  result_.steps = promotion.step;
  series_.discard();
}

bool TimedRun::promote(long step, long resumed, Model to, const std::string& relative_to) {
  const Promotion promotion{step, resumed, model_, to, monitor_->estimate()};
  if (request_.on_bound == "stop") {
    stop_at_bound(promotion, relative_to);
    return false;
  }
  monitor_->add(promotion);
  result_.model_report = monitor_->report();
  executor_.reset(); // frees its memory before the next executor needs it
  executor_ = created(to);
  executor_->write(0, monitor_->good_state());
  begin_balance(resumed, &monitor_->good_state());
  if (to == Model::spatial)
    left_out_ = {monitor_->left_out(), monitor_->tolerance()}, monitor_.reset();
  else
    monitor_->go_on_with(to);
  return true;
}

bool TimedRun::holds_at_end() {
  if (monitor_) return monitor_->holds_at_end();
  if (!left_out_) return true;
  const KindValues end = largest_of_kinds(whole_state(*executor_, problem_.lattice.element_count));
  return relative_error(problem_, left_out_->errors, end) <= left_out_->tolerance;
}

void TimedRun::begin_anew() {
  step_ = result_.resumed_step = 0;
  if (saved_) saved_->take(0);
  left_out_.reset();
  if (guard_) guard_->forget();
  write_initial_state(*executor_, problem_);
  begin_balance(0);
  series_.discard();
  series_ = new_series();
  if (history_) history_->clear();
  if (meter_) meter_.emplace(problem_, plan_.reference->states);
  result_.check = {};
}

} // namespace dss
