/// Saves a run while it computes, and continues a saved one.
#include "experiments/run/checkpoint/saving.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "solver/error.hpp"
#include "solver/io/kept_numbers.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

/// With adaptive steps, ranks ask one another every so many steps.
constexpr long adaptive_chunk = 32;
constexpr double quiet_s = 2;     ///< Shorter runs show no progress.
constexpr double between_s = 0.2; ///< between two lines of progress

Model model_of(int number) {
  const auto* found = std::ranges::find(models, Model(number));
  if (found == models.end()) throw InputError(fmt::format("there is no model {}", number));
  return *found;
}

} // namespace

void TimedRun::begin_saving() {
  progress_.emplace();
  shown_ = Clock::now();
  if (!request_.has_checkpoint()) return;
  const int width = kept_fields(*executor_);
  if (width == 0) refuse_saving(request_, result_.variant);
  is_watched_ = plan_.model_choice.is_bounded;
  const auto identify = [&] {
    identity_.emplace(request_, plan_, is_watched_, result_.has_fma, width, stops());
  };
  series_.keep_finished();
  if (!request_.restart.empty()) {
    SavedRun saved(request_.restart);
    // Runs of ranks and hybrids are not watched, and their model is not left in mid-run.
    is_watched_ = is_watched_ && !saved.standing().watch_kept.empty();
    identify();
    saved.require_same(*identity_);
    resume(saved);
  } else {
    identify();
  }
  if (request_.checkpoint.empty()) return;
  saved_.emplace(parse_checkpoint_interval(request_.checkpoint_every), steps_done());
  interrupts_.emplace();
  if (adaptive_)
    adaptive_->visit_before([this, between = std::min(adaptive_chunk, chunk_steps())] {
      if (steps_done() % between == 0 || saved_->is_due_by_steps(steps_done())) save_or_end();
    });
}

void TimedRun::end_saving() {
  if (saved_) // a longer run may go on from here
    if (const std::string failure = save(); !failure.empty())
      progress_->note(failure + "; the run goes on");
  saved_.reset();
  interrupts_.reset();
  progress_.reset();
}

void TimedRun::resume(SavedRun& saved) {
  const Standing& standing = saved.standing();
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}", request_.restart, what));
  };
  const bool has_other_model = standing.model != model_;
  if (has_other_model && (adaptive_ || plan_.model_choice.asked != "auto" ||
                          !why_not(standing.model, problem_).empty()))
    refuse(fmt::format("its model {} is none of this run; take an earlier file",
                       name(standing.model)));
  if (plan_.expected && plan_.expected->steps <= standing.step)
    refuse_passed_state(request_, plan_.expected->steps);
  if (has_other_model) {
    executor_.reset();
    executor_ = created(standing.model);
  }
  try {
    take_watch(standing.watch_kept);
    TakeNumbers take(standing.steps_kept);
    if (adaptive_) adaptive_->each_kept(take);
    if (!take.is_empty()) throw InputError("it has more numbers than this run keeps");
  } catch (const InputError& error) {
    refuse(fmt::format("{}; take an earlier file", error.what()));
  }
  const double end = double(plan_.steps) * plan_.dt;
  if (adaptive_ ? adaptive_->time() >= end : standing.step >= plan_.steps)
    refuse(fmt::format("the run has done all of its {} steps; give more --steps, or {} to do the "
                       "last ones again",
                       standing.step, earlier_checkpoint(request_.restart)));
  saved.restore(*executor_, problem_.lattice.element_count);
  step_ = adaptive_ ? 0 : standing.step;
  result_.resumed_step = standing.step;
  // The energy is followed from the first look on.
  balance_.reset();
  balance_start_.reset();
  std::vector<double> times;
  for (const long frame : plan_.frame_steps)
    if (is_passed(frame)) times.push_back(double(frame) * plan_.dt);
  if (is_root_ && !request_.output.empty()) series_.go_on(times);
  if (history_) history_->go_on(standing.history);
}

bool TimedRun::is_passed(long stop) const {
  if (result_.resumed_step == 0) return false;
  return adaptive_ ? double(stop) * plan_.dt <= adaptive_->time() : stop <= step_;
}

long TimedRun::chunk(long most) const {
  if (plan_.method->has_leaps()) return std::min(leap_steps, most);
  if (!saved_) return std::min(signal_steps, most);
  return saved_->steps_left(step_, std::min(chunk_steps(), most));
}

long TimedRun::chunk_steps() const {
  return steps_of_pause(double(problem_.lattice.element_count));
}

void TimedRun::save_or_end() {
  if (steps_done() == result_.resumed_step) return; // nothing new
  const Saving saving =
      common_saving(*executor_, saved_->is_due(steps_done()), interrupts_->is_asked());
  if (saving == Saving::none) return;
  const std::string failure = save();
  if (saving == Saving::save_and_end) {
    progress_.reset();
    end_saved(*interrupts_, failure, steps_done(), request_.checkpoint);
  }
  if (!failure.empty()) progress_->note(failure + "; the run goes on");
}

std::string TimedRun::save() {
  Standing standing{steps_done(), model_, {}, watch_kept(), {}};
  PutNumbers put(standing.steps_kept);
  if (adaptive_) adaptive_->each_kept(put);
  saved_->take(steps_done());
  if (history_) standing.history = history_->kept();
  return write_checkpoint(request_.checkpoint, *identity_, standing, *executor_,
                          problem_.lattice.element_count, is_root_);
}

std::vector<double> TimedRun::watch_kept() {
  std::vector<double> kept;
  if (!is_watched_) return kept;
  PutNumbers put(kept);
  put(bool(monitor_)), put(bool(left_out_));
  if (monitor_) monitor_->each_kept(put);
  if (left_out_) put(left_out_->errors), put(left_out_->tolerance);
  const ModelReport& report = result_.model_report;
  put(report.largest_rotation), put(report.estimate), put(report.looks);
  for (const Promotion& one : report.promotions)
    put(one.step), put(one.resumed_step), put(int(one.from)), put(int(one.to)), put(one.estimate);
  return kept;
}

void TimedRun::take_watch(std::span<const double> kept) {
  monitor_.reset();
  if (!is_watched_) {
    result_.model_choice.chosen = model_;
    if (std::exchange(result_.model_choice.is_bounded, false))
      result_.model_choice.why = "the model of the run that was interrupted, which nothing watched";
    return;
  }
  TakeNumbers take(kept);
  bool has_monitor = false, has_left_out = false;
  take(has_monitor), take(has_left_out);
  if (has_monitor) {
    monitor_.emplace(problem_, model_, plan_.model_choice.tolerance, plan_.steps, plan_.dt);
    monitor_->each_kept(take);
  }
  if (has_left_out) {
    left_out_.emplace();
    take(left_out_->errors), take(left_out_->tolerance);
  }
  ModelReport& report = result_.model_report;
  take(report.largest_rotation), take(report.estimate), take(report.looks);
  while (!take.is_empty()) {
    Promotion one;
    int from = 0, to = 0;
    take(one.step), take(one.resumed_step), take(from), take(to), take(one.estimate);
    one.from = model_of(from), one.to = model_of(to);
    report.promotions.push_back(one);
    if (monitor_) monitor_->add(one);
  }
}

void TimedRun::show_progress(long step) {
  if (!progress_ || !progress_->is_terminal() || !is_root_) return;
  const double wait_s = is_progress_shown_ ? between_s : quiet_s;
  if (seconds_since(shown_) < wait_s) return;
  progress_->show(double(step), double(plan_.steps), problem_.name);
  shown_ = Clock::now();
  is_progress_shown_ = true;
}

} // namespace dss
