#include "experiments/run/timed/timed_run.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/rank_sums.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

DeviceUse since(const DeviceUse& before, DeviceUse now) {
  now.launches -= before.launches;
  now.to_device_bytes -= before.to_device_bytes;
  now.from_device_bytes -= before.from_device_bytes;
  now.transfer_s -= before.transfer_s;
  return now;
}

} // namespace

TimedRun::TimedRun(const RunPlan& plan, const RunRequest& request, FileSet& outputs,
                   RunResult& result)
    : plan_(plan), request_(request), problem_(plan.scene.problem), outputs_(outputs),
      result_(result), executor_(created(plan.model)), series_(new_series()),
      is_root_(request.is_root), oracle_check_(plan) {
  if (is_root_ && !request.history.empty())
    history_.emplace(request.history, problem_, plan.probes);
  if (plan.reference) meter_.emplace(problem_, plan.reference->states);
  if (plan.model_choice.is_bounded)
    monitor_.emplace(problem_, plan.model, plan.model_choice.tolerance, plan.steps, plan.dt);
}

void TimedRun::run() {
  describe_executor(*executor_, *plan_.plugin, result_);
  std::unique_ptr<Guard> guard = made_guard();
  std::optional<FlippedBit> flip = FlippedBit::of_environment();
  if (flip) flip->require_within(plan_, *executor_);
  warm_up();
  write_initial_state(*executor_, problem_);
  begin_balance(0);
  if (plan_.adaptive) adaptive_.emplace(adaptive_steps());
  begin_saving();
  guard_ = std::move(guard);
  flip_ = flip;
  const Traffic before = traffic(*executor_);
  const DeviceUse used_before = device_use(*executor_);
  const double evaluations_before = evaluations(*executor_);
  while (!pass_all_stops())
    if (result_.status != "ok") return;
  end_saving();
  guard_.reset();
  flip_.reset();
  if (meter_)
    result_.reference = {plan_.reference->times, plan_.reference->error, meter_->result()};
  put_traffic(*executor_, since(before, traffic(*executor_)), double(result_.advanced_steps()),
              result_);
  result_.usage = of_all_ranks(*executor_, result_.usage);
  result_.hybrid = hybrid_info(*executor_);
  result_.factors = factor_info(*executor_);
  if (plan_.method->has_leaps()) result_.evaluations = evaluations(*executor_) - evaluations_before;
  result_.device_use = since(used_by_looks_, since(used_before, device_use(*executor_)));
  if (const std::string written = series_.finish(); !written.empty())
    result_.files.push_back(written);
  if (history_) {
    history_->write(outputs_);
    result_.files.push_back(request_.history);
    result_.probes = history_->probe_texts();
  }
}

void TimedRun::warm_up() {
  long steps = request_.warmup_steps;
  const auto start = Clock::now();
  // Kernels may leave new threads on one processor for some 0.1 s.
  const double least_s = result_.workers > 1 ? request_.warmup_s : 0;
  const auto is_more_wanted = [&] {
    const std::vector<double> elapsed = gather(*executor_, seconds_since(start));
    return elapsed.front() < least_s; // all ranks decide by the clock of the first
  };
  RunResult discarded;
  for (bool is_wanted = steps > 0; is_wanted; is_wanted = is_more_wanted()) {
    write_initial_state(*executor_, problem_);
    if (plan_.adaptive)
      adaptive_steps().advance_to(double(steps) * plan_.dt);
    else if (!advance_to(0, steps, discarded))
      return;
    steps = std::clamp(2 * steps, request_.warmup_steps, std::max(plan_.steps, steps));
  }
}

RunResult TimedRun::sample(double least_s) {
  RunResult again;
  again.runs = 0;
  do {
    write_initial_state(*executor_, problem_);
    if (plan_.adaptive)
      again.wall_s += adapt_again(again.usage);
    else if (plan_.method->has_leaps())
      leap_again(again);
    else
      advance_to(0, plan_.steps, again);
    ++again.runs;
  } while (again.wall_s < least_s);
  again.wall_s /= double(again.runs);
  again.usage = of_all_ranks(*executor_, again.usage);
  return again;
}

void TimedRun::take_samples(long samples, double least_s) {
  if (!result_.model_report.promotions.empty()) return;
  // All ranks decide by the clock of the first.
  const auto of_root = [&](double wall_s) { return gather(*executor_, wall_s).front(); };
  double fastest_s = of_root(result_.wall_s);
  long taken = fastest_s < least_s ? 0 : 1;
  result_.samples = samples;
  if (taken == samples) return;
  for (; taken < samples; ++taken) {
    const RunResult again = sample(least_s);
    if (state_digest(*executor_, problem_.lattice.element_count, plan_.precision) !=
        result_.digest) {
      result_.status = "wrong";
      result_.reason = "the bits of a later run from the same state are not those of the first";
      return;
    }
    // Checks of the model were timed only in the first run.
    const double wall_s = of_root(again.wall_s) + result_.model_report.look_s;
    if (taken > 0 && wall_s >= fastest_s) continue;
    fastest_s = wall_s;
    result_.wall_s = wall_s, result_.usage = again.usage, result_.runs = again.runs;
  }
}

std::unique_ptr<Executor> TimedRun::created(Model model) {
  const auto start = Clock::now();
  auto executor =
      make_executor(*plan_.plugin, {problem_, *plan_.method, model, plan_.precision, plan_.dt,
                                    request_.threads, nullptr, &plan_.distribution, request_.device,
                                    request_.hybrid, plan_.rotation, request_.tile});
  if (!has_begun_) result_.first_step_s = seconds_since(start);
  model_ = model;
  return executor;
}

bool TimedRun::pass_all_stops() {
  long step = step_;
  if (steps_done() == 0) look(step);
  for (const long stop : stops()) {
    if (is_passed(stop)) continue;
    const bool has_arrived = adaptive_  ? adapt_to(stop)
                             : monitor_ ? advance_watched(step, stop)
                                        : advance_to(step, stop, result_);
    if (!has_arrived || !is_finite_after(stop)) return false;
    step = step_ = stop;
    if (step == plan_.steps && !holds_at_end()) {
      if (!monitor_ || promote(step, 0, Model::spatial, "of what the end has itself")) begin_anew();
      return false;
    }
    look(step);
  }
  return true;
}

std::vector<long> TimedRun::stops() const {
  std::vector<long> steps = oracle_check_.stops();
  steps.insert(steps.end(), plan_.frame_steps.begin(), plan_.frame_steps.end());
  steps.insert(steps.end(), plan_.history_steps.begin(), plan_.history_steps.end());
  for (long k = 1; meter_ && k <= plan_.reference->times.count; ++k)
    steps.push_back(k * plan_.steps_between);
  if (const long between = balance_interval(); between > 0)
    for (long step = between; step < plan_.steps; step += between) steps.push_back(step);
  steps.push_back(plan_.steps);
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  std::erase(steps, 0);
  return steps;
}

bool TimedRun::advance_to(long step, long stop, RunResult& result) {
  bool is_finite = true;
  // Not for each chunk: reading the queues would cost as much as the chunk of a small scene. So it
  // also counts the signals' rows and the wait for the start of other ranks.
  std::optional<UsageMeter> usage(std::in_place);
  const auto is_guarded = [&] {
    if (!guard_ || !guard_->is_due(step)) return true;
    result.usage += usage->read();
    const std::string difference = guard_->look(*executor_, model_, step);
    usage.emplace();
    return is_sound(difference, step, result);
  };
  while (step < stop && is_finite) {
    if (!is_guarded()) return false;
    if (flip_) flip_->apply(*executor_, step, plan_.precision);
    if (saved_ && (!guard_ || guard_->has_checked(step))) step_ = step, save_or_end();
    const bool is_very_first = !std::exchange(has_begun_, true) && !plan_.method->has_leaps();
    const long count = is_very_first ? 1 : chunk(steps_to_pause(step, stop));
    const std::vector<double> signals = signal_rows(problem_, *plan_.method, plan_.dt, step, count);
    // Lets all ranks start together, so that work of rank 0 alone is not timed.
    if (plan_.plugin->is_distributed) gather(*executor_, 0);
    const auto start = Clock::now();
    const Outcome outcome = executor_->advance(count, signals);
    const double wall_s = seconds_since(start);
    result.wall_s += wall_s;
    if (is_very_first) result_.first_step_s += wall_s;
    is_finite = outcome.is_finite;
    if (!is_finite) report_failure(step + outcome.step, outcome, result);
    step += count;
    show_progress(step);
  }
  const bool is_right = is_finite && (step < plan_.steps || is_guarded());
  result.usage += usage->read();
  return is_right;
}

long TimedRun::steps_to_pause(long step, long stop) const {
  long most = stop - step;
  if (guard_) most = guard_->steps_left(step, most);
  return flip_ ? flip_->steps_left(step, most) : most;
}

void TimedRun::report_failure(long step, const Outcome& outcome, RunResult& result) {
  report_breakdown(step, outcome, result);
  if (guard_) is_sound(guard_->judge_failure(*executor_, step, outcome.element), step, result);
}

std::unique_ptr<Guard> TimedRun::made_guard() {
  if (request_.guard == 0) return nullptr;
  const std::string& variant = result_.variant; // of ranks: "mpi:avx512"
  return std::make_unique<Guard>(request_, plan_, *executor_, variant.substr(variant.find(':') + 1),
                                 result_.has_fma);
}

bool TimedRun::is_sound(const std::string& difference, long step, RunResult& result) {
  result.guard = guard_->report();
  if (difference.empty()) return true;
  result.status = "faulty";
  result.steps = step;
  result.reason = difference;
  return false;
}

bool TimedRun::is_finite_after(long step) {
  const auto element = first_not_finite(*executor_, problem_.lattice.element_count);
  if (element) report_breakdown(step - 1, {false, 0, *element}, result_);
  return !element;
}

void TimedRun::report_breakdown(long step, const Outcome& outcome, RunResult& result) const {
  result.status = "unstable";
  result.steps = step + 1;
  result.reason = fmt::format("{}: {}", problem_.name, breakdown_reason(plan_, outcome, step));
}

AdaptiveSteps TimedRun::adaptive_steps() {
  return {*executor_,      problem_, *plan_.method,
          *plan_.adaptive, plan_.dt, double(plan_.steps) * plan_.dt};
}

bool TimedRun::adapt_to(long stop) {
  if (plan_.plugin->is_distributed) gather(*executor_, 0); // as in advance_to
  const UsageMeter usage;
  const auto failure = adaptive_->advance_to(double(stop) * plan_.dt);
  result_.usage += usage.read();
  const AdaptiveCounts& counts = adaptive_->counts();
  if (!std::exchange(has_begun_, true)) result_.first_step_s += counts.first_step_s;
  result_.wall_s = counts.wall_s;
  result_.steps = counts.accepted;
  result_.rejected_steps = counts.rejected;
  result_.evaluations = double(counts.accepted + counts.rejected) * plan_.method->stages;
  if (counts.accepted > 0)
    result_.least_step_s = counts.least_dt, result_.largest_step_s = counts.largest_dt;
  if (!failure) return true;
  result_.status = "unstable";
  result_.reason = *failure;
  return false;
}

double TimedRun::adapt_again(Usage& usage) {
  AdaptiveSteps adaptive = adaptive_steps();
  if (plan_.plugin->is_distributed) gather(*executor_, 0); // as in advance_to
  const UsageMeter meter;
  for (const long stop : stops()) adaptive.advance_to(double(stop) * plan_.dt);
  usage += meter.read();
  return adaptive.counts().wall_s;
}

// Leaps of other lengths have other bits, so that pauses stay where they were.
void TimedRun::leap_again(RunResult& result) {
  long step = 0;
  for (const long stop : stops()) advance_to(std::exchange(step, stop), stop, result);
}

void TimedRun::look(long step) {
  const std::size_t count = problem_.lattice.element_count;
  if (oracle_check_.is_wanted(step)) {
    const std::vector<double> state = whole_state(*executor_, count);
    const WorkAlone alone(*executor_, is_root_);
    if (is_root_) oracle_check_.look(step, state, equations(), result_.check);
  }
  if (const long between = balance_interval(); between > 0 && step > 0 && step % between == 0) {
    const DeviceUse before = device_use(*executor_);
    if (balance_) {
      look_at_energy(*balance_, double(step) * plan_.dt);
    } else { // a continued run begins here
      const std::vector<double> state = whole_state(*executor_, count);
      begin_balance(step, &state);
    }
    used_by_looks_ += since(before, device_use(*executor_));
  }
  if (meter_ && step > 0 && step % plan_.steps_between == 0)
    meter_->add(std::size_t(step / plan_.steps_between - 1), whole_state(*executor_, count));
  write_frame(step);
}

void TimedRun::write_frame(long step) {
  const bool has_frame = std::ranges::binary_search(plan_.frame_steps, step),
             has_row = std::ranges::binary_search(plan_.history_steps, step);
  if (!has_frame && !has_row) return;
  const std::vector<double> state = whole_state(*executor_, problem_.lattice.element_count);
  const WorkAlone alone(*executor_, is_root_);
  const double time = double(step) * plan_.dt;
  const std::vector<double> signals = signals_at(problem_, time);
  if (has_frame) series_.add(problem_, state, equations(), signals, time);
  if (has_row && history_) history_->add(step, time, state, equations(), signals);
}

} // namespace dss
