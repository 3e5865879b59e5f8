#include "experiments/runner/run.hpp"
#include "experiments/runner/adaptive_steps.hpp"
#include "experiments/runner/breakdown.hpp"
#include "experiments/runner/output.hpp"
#include "experiments/runner/run_plan.hpp"
#include "experiments/runner/state_access.hpp"
#include "solver/model/energy.hpp"
#include "solver/numerics/denormals.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

constexpr long batch_steps = 256;                  ///< signals are made for so many steps at once
constexpr std::size_t energy_elements = 2'000'000; ///< a second copy of a larger state would count in the memory

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// While one lives, this rank does what only one need do, and the others wait.
class WorkAlone {
public:
  WorkAlone(Executor& executor, bool is_root) : executor_(executor), is_root_(is_root) {
    if (is_root_) executor_.work_alone(true);
  }
  WorkAlone(const WorkAlone&) = delete;
  WorkAlone& operator=(const WorkAlone&) = delete;
  ~WorkAlone() {
    if (is_root_) executor_.work_alone(false);
  }

private:
  Executor& executor_;
  bool is_root_;
};

/// Advances an executor by pieces between the steps at which somebody looks, and times nothing but advance().
class TimedRun {
public:
  TimedRun(const RunPlan& plan, const RunRequest& request, RunResult& result)
      : plan_(plan), request_(request), problem_(plan.scene.problem), result_(result), executor_(created(plan.model)),
        series_(new_series()), is_root_(request.is_root) {
    if (plan.reference) meter_.emplace(problem_, plan.reference->states);
    if (plan.model_choice.is_bounded)
      monitor_.emplace(problem_, plan.model, plan.model_choice.tolerance, plan.steps, plan.dt);
  }

  void run(long warmup_steps) {
    result_.schedule = executor_->schedule();
    result_.bytes = executor_->bytes();
    result_.workers = executor_->workers();
    result_.ranks = executor_->rank_info();
    if (!result_.ranks.variant.empty()) {
      result_.variant = fmt::format("{}:{}", plan_.plugin->name, result_.ranks.variant);
      result_.isa = result_.ranks.isa;
      result_.has_fma = result_.ranks.has_fma;
    }
    if (warmup_steps > 0) {
      RunResult discarded;
      write_initial_state(*executor_, problem_);
      if (plan_.adaptive)
        adaptive_steps().advance_to(double(warmup_steps) * plan_.dt);
      else
        advance_to(0, warmup_steps, discarded);
    }
    write_initial_state(*executor_, problem_);
    if (plan_.adaptive) adaptive_.emplace(adaptive_steps());
    const Traffic before = executor_->traffic();
    const DeviceUse used_before = executor_->device_use();
    while (!pass_all_stops())
      if (result_.status != "ok") return;
    if (meter_) result_.reference = {plan_.reference->times, plan_.reference->error, meter_->result()};
    sum_over_ranks(before);
    result_.hybrid = executor_->hybrid_info();
    result_.device_use = since(used_before, executor_->device_use());
    if (const std::string written = series_.finish(); !written.empty()) result_.files.push_back(written);
  }

  /// Model that computed last, and the oracle's rotations that have its equations.
  Model model() const { return model_; }
  Rotation equations() const { return plan_.rotation == Rotation::quaternion ? rotation_of(model_) : plan_.rotation; }

  /// Times a short run anew: from the start, until the clock has run for `least_s`; one of equal steps straight through. The run
  /// that was looked at while it went warms up.
  void repeat(double least_s) {
    if (result_.wall_s >= least_s || !result_.model_report.promotions.empty()) return;
    RunResult again;
    long runs = 0;
    for (; again.wall_s < least_s; ++runs) {
      write_initial_state(*executor_, problem_);
      if (plan_.adaptive)
        again.wall_s += adapt_again(again.usage);
      else
        advance_to(0, plan_.steps, again);
    }
    result_.wall_s = again.wall_s / double(runs) + result_.model_report.look_s; // looks were timed in the first run
    result_.usage = again.usage;
    result_.runs = runs;
    if (state_digest(*executor_, problem_.lattice.element_count, plan_.precision) == result_.digest) return;
    result_.status = "wrong";
    result_.reason = "the bits of a second run from the same state are not those of the first";
  }

  Executor& executor() { return *executor_; }

private:
  std::unique_ptr<Executor> created(Model model) {
    const auto start = Clock::now();
    auto executor =
        plan_.plugin->create({problem_, *plan_.method, model, plan_.precision, plan_.dt, request_.threads, nullptr,
                              &plan_.distribution, request_.device, request_.hybrid, plan_.rotation});
    if (!has_begun_) result_.first_step_s = seconds_since(start);
    model_ = model;
    return executor;
  }

  FrameSeries new_series() const { return {request_.is_root ? request_.output : "", plan_.frame_steps.size() > 1}; }

  /// From the initial state to the end. @return false if the run ends before, or must begin anew with another model
  bool pass_all_stops() {
    long step = 0;
    look(step);
    for (const long stop : stops()) {
      const bool has_arrived = adaptive_  ? adapt_to(stop)
                               : monitor_ ? advance_watched(step, stop)
                                          : advance_to(step, stop, result_);
      if (!has_arrived || !is_finite_after(stop)) return false;
      step = stop;
      if (step == plan_.steps && !holds_at_end()) {
        if (!monitor_ || promote(step, 0, Model::spatial, "of what the end has itself")) begin_anew();
        return false;
      }
      look(step);
    }
    return true;
  }

  /// To a stop, with looks at the error of the model on the way; a larger model goes on where it may exceed the tolerance.
  bool advance_watched(long step, long stop) {
    while (step < stop) {
      if (!monitor_) return advance_to(step, stop, result_);
      const long next = monitor_->next_look(step, stop);
      RunResult tried = result_;
      const bool is_finite = advance_to(step, next, tried);
      result_.wall_s = tried.wall_s, result_.usage = tried.usage;
      if (is_finite && monitor_->look(*executor_, next)) {
        step = next;
        result_.model_report = monitor_->report();
        continue;
      }
      if (!is_finite && request_.on_bound == "stop") {
        result_ = std::move(tried); // unstable, whatever the model
        return false;
      }
      step = monitor_->good_step();
      if (!promote(next, step, monitor_->promoted(), "")) return false;
    }
    return true;
  }

  /// @param step  at which the bound was exceeded  @param resumed  from whose state the run goes on; the last good one, or 0 for the start
  /// @param relative_to  in words, where it is not the largest motion so far
  /// @return false if the run is to stop instead
  bool promote(long step, long resumed, Model to, const std::string& relative_to) {
    const Promotion promotion{step, resumed, model_, to, monitor_->estimate()};
    if (request_.on_bound == "stop") {
      result_.status = "bound";
      const std::string error = relative_to.empty()
                                    ? fmt::format("{:.3g}, above {:g} of the tolerance {:g}", promotion.estimate,
                                                  bounded_share, monitor_->tolerance())
                                    : fmt::format("above the tolerance {:g} {}", monitor_->tolerance(), relative_to);
      result_.reason = fmt::format("after step {} (t = {:g} s) the error of model {} may be {}; take --model {}, or "
                                   "--on-bound promote",
                                   step, double(step) * plan_.dt, name(model_), error, name(to));
      result_.steps = step;
      series_.discard();
      return false;
    }
    monitor_->add(promotion);
    result_.model_report = monitor_->report();
    executor_.reset(); // before the next takes its memory
    executor_ = created(to);
    executor_->write(0, monitor_->good_state());
    if (to == Model::spatial)
      left_out_ = {monitor_->left_out(), monitor_->tolerance()}, monitor_.reset();
    else
      monitor_->go_on_with(to);
    return true;
  }

  /// Whether what smaller models left out is within the tolerance of the end: a motion may end where it passes its rest.
  bool holds_at_end() {
    if (monitor_) return monitor_->holds_at_end();
    if (!left_out_) return true;
    const KindValues end = largest_of_kinds(whole_state(*executor_, problem_.lattice.element_count));
    return relative_error(problem_, left_out_->errors, end) <= left_out_->tolerance;
  }

  /// Nothing between is known to be good.
  void begin_anew() {
    left_out_.reset();
    write_initial_state(*executor_, problem_);
    series_.discard();
    series_ = new_series();
    if (meter_) meter_.emplace(problem_, plan_.reference->states);
    result_.check = {};
  }

  static DeviceUse since(const DeviceUse& before, DeviceUse now) {
    now.launches -= before.launches;
    now.to_device_bytes -= before.to_device_bytes;
    now.from_device_bytes -= before.from_device_bytes;
    now.transfer_s -= before.transfer_s;
    return now;
  }

  /// Steps at which the run pauses, ascending, the last step among them.
  std::vector<long> stops() const {
    std::vector<long> steps = plan_.frame_steps;
    if (plan_.expected) steps.push_back(plan_.expected->steps);
    if (has_tail()) steps.push_back(tail_start());
    for (long k = 1; meter_ && k <= plan_.reference->times.count; ++k) steps.push_back(k * plan_.steps_between);
    steps.push_back(plan_.steps);
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    std::erase(steps, 0);
    return steps;
  }

  /// A leapfrog cannot start anew from a state without its half-step velocities, so only Runge-Kutta runs have their
  /// ends checked.
  bool has_tail() const {
    return plan_.expected && plan_.tail_steps > 0 && !plan_.adaptive && plan_.expected->steps < plan_.steps &&
           plan_.method->family == Method::Family::runge_kutta;
  }
  long tail_start() const { return std::max(plan_.expected->steps, plan_.steps - plan_.tail_steps); }

  AdaptiveSteps adaptive_steps() {
    return {*executor_, problem_, *plan_.method, *plan_.adaptive, plan_.dt, double(plan_.steps) * plan_.dt};
  }

  /// The whole adaptive run once more, past the same stops, which steps are cut to. @return its time [s]
  double adapt_again(Usage& usage) {
    AdaptiveSteps adaptive = adaptive_steps();
    const UsageMeter meter;
    for (const long stop : stops()) adaptive.advance_to(double(stop) * plan_.dt);
    usage += meter.read();
    return adaptive.counts().wall_s;
  }

  /// To the time of that step, were all as long as the first.
  bool adapt_to(long stop) {
    if (plan_.plugin->is_distributed) executor_->gather(0); // as in advance_to
    const UsageMeter usage;
    const auto failure = adaptive_->advance_to(double(stop) * plan_.dt);
    result_.usage += usage.read();
    const AdaptiveCounts& counts = adaptive_->counts();
    if (!std::exchange(has_begun_, true)) result_.first_step_s += counts.first_step_s;
    result_.wall_s = counts.wall_s;
    result_.steps = counts.accepted;
    result_.rejected_steps = counts.rejected;
    result_.evaluations = double(counts.accepted + counts.rejected) * plan_.method->stages;
    if (counts.accepted > 0) result_.least_step_s = counts.least_dt, result_.largest_step_s = counts.largest_dt;
    if (!failure) return true;
    result_.status = "unstable";
    result_.reason = *failure;
    return false;
  }

  bool advance_to(long step, long stop, RunResult& result) {
    bool is_finite = true;
    while (step < stop && is_finite) {
      const bool is_very_first = !std::exchange(has_begun_, true);
      const long count = std::min(is_very_first ? 1 : batch_steps, stop - step);
      const std::vector<double> signals = signal_rows(problem_, *plan_.method, plan_.dt, step, count);
      if (plan_.plugin->is_distributed)
        executor_->gather(0); // all ranks begin together: what rank 0 did alone is not timed
      const UsageMeter usage; // over the same region as the clock: CPU / wall is judged
      const auto start = Clock::now();
      const Outcome outcome = executor_->advance(count, signals);
      const double wall_s = seconds_since(start);
      result.wall_s += wall_s;
      if (is_very_first) result_.first_step_s += wall_s;
      result.usage += usage.read();
      is_finite = outcome.is_finite;
      if (!is_finite) report_breakdown(step + outcome.step, outcome, result);
      step += count;
    }
    return is_finite;
  }

  /// Kernels watch velocities; a number that left the range first in the very step at which somebody looks is found here.
  bool is_finite_after(long step) {
    const auto element = first_not_finite(*executor_, problem_.lattice.element_count);
    if (element) report_breakdown(step - 1, {false, 0, *element}, result_);
    return !element;
  }

  void sum_over_ranks(const Traffic& before) {
    const auto sum = [&](double value) {
      double total = 0;
      for (const double of_rank : executor_->gather(value)) total += of_rank;
      return total;
    };
    const Traffic now = executor_->traffic();
    const double steps = double(result_.steps);
    result_.messages_per_step = sum(now.messages - before.messages) / steps;
    result_.bytes_per_step = sum(now.bytes - before.bytes) / steps;
    result_.communication_share = sum(now.wait_s - before.wait_s) / (result_.wall_s * result_.ranks.ranks);
    result_.usage.cpu_s = sum(result_.usage.cpu_s);
    result_.usage.wait_s = sum(result_.usage.wait_s);
    result_.usage.involuntary_switches = long(sum(double(result_.usage.involuntary_switches)));
  }

  void report_breakdown(long step, const Outcome& outcome, RunResult& result) const {
    result.status = "unstable";
    result.steps = step + 1;
    result.reason = fmt::format("{}: {}; take --dt below {:.6g} s", problem_.name,
                                breakdown_text(outcome.what, step, plan_.dt, outcome.element),
                                plan_.dt > plan_.stability_limit ? plan_.stability_limit : 0.5 * plan_.dt);
  }

  void look(long step) {
    const std::size_t count = problem_.lattice.element_count;
    if (plan_.expected && step == plan_.expected->steps) {
      CheckResult& check = result_.check;
      check.is_done = true;
      check.how = plan_.adaptive ? fmt::format("oracle at t = {:g} s", double(step) * plan_.dt)
                                 : fmt::format("oracle after {} steps", step);
      check.tolerance = plan_.tolerance().run;
      const std::vector<double> state = whole_state(*executor_, count);
      const WorkAlone alone(*executor_, is_root_);
      if (is_root_) check.error = state_error(problem_, plan_.expected->state, state);
    }
    if (meter_ && step > 0 && step % plan_.steps_between == 0)
      meter_->add(std::size_t(step / plan_.steps_between - 1), whole_state(*executor_, count));
    if (has_tail() && step == tail_start()) tail_state_ = whole_state(*executor_, count);
    if (has_tail() && step == plan_.steps) check_tail();
    if (std::binary_search(plan_.frame_steps.begin(), plan_.frame_steps.end(), step)) {
      const std::vector<double> state = whole_state(*executor_, count);
      const WorkAlone alone(*executor_, is_root_);
      series_.add(problem_, state, equations(), double(step) * plan_.dt);
    }
  }

  void check_tail() {
    const long steps = plan_.steps - tail_start();
    const std::vector<double> state = whole_state(*executor_, problem_.lattice.element_count);
    if (!is_root_) return;
    const WorkAlone alone(*executor_, true);
    const auto expected =
        continue_by_oracle(problem_, *plan_.method, equations(), plan_.dt, tail_start(), steps, tail_state_);
    result_.check.tail_error = state_error(problem_, expected, state);
    result_.check.how += fmt::format(", and over the last {}", steps);
  }

  const RunPlan& plan_;
  const RunRequest& request_;
  const Problem& problem_;
  RunResult& result_;
  bool has_begun_ = false;
  Model model_ = Model::spatial;
  std::unique_ptr<Executor> executor_;
  FrameSeries series_;
  bool is_root_;
  std::optional<AdaptiveSteps> adaptive_;
  /// By models before the spatial one, which has no bound to keep.
  struct LeftOut {
    KindBounds errors;
    double tolerance;
  };
  std::optional<LeftOut> left_out_;
  std::vector<double> tail_state_;
  std::optional<AccuracyMeter> meter_;
  std::optional<ModelMonitor> monitor_; ///< while the model is one of small rotations that auto chose
};

RunResult described(const RunPlan& plan, const RunRequest& request) {
  RunResult result;
  result.scene = plan.scene.name;
  result.variant = plan.plugin->name;
  result.isa = plan.plugin->isa;
  result.has_fma = plan.plugin->has_fma;
  result.model = name(plan.model);
  result.precision = name(plan.precision);
  result.integrator = plan.method->name;
  result.stages = plan.method->stages;
  result.rotation = name(plan.rotation);
  result.model_choice = plan.model_choice;
  result.threads = request.threads;
  result.elements = plan.scene.problem.lattice.element_count;
  result.links = plan.scene.problem.link_count();
  result.steps = plan.steps;
  result.warmup_steps = request.warmup_steps;
  result.dt_s = plan.dt;
  result.stability_limit_s = plan.stability_limit;
  result.end_s = double(plan.steps) * plan.dt;
  result.adaptive = plan.adaptive;
  if (!plan.method->is_implicit()) result.evaluations = double(plan.steps) * plan.method->stages;
  return result;
}

/// Of the final energy against that of the start; nothing where it need not be the same, or is zero.
std::optional<double> energy_drift(const Problem& problem, Rotation rotation, std::optional<double> final_j) {
  if (!final_j || !conserves_energy(problem)) return {};
  const double start_j = total_energy(problem, initial_state(problem), rotation);
  if (start_j == 0) return {};
  return *final_j / start_j - 1;
}

void judge(const CheckResult& check, RunResult& result) {
  if (!check.is_done || check.is_passed()) return;
  result.status = "wrong";
  result.reason =
      check.tail_error && !(*check.tail_error <= check.tolerance)
          ? fmt::format("error {:.3g} over the last steps exceeds the tolerance {:.3g}", *check.tail_error,
                        check.tolerance)
          : fmt::format("error {:.3g} ({}) exceeds the tolerance {:.3g}", check.error, check.how, check.tolerance);
}

} // namespace

RunResult run_scene(const RunRequest& request) {
  const RunPlan plan = plan_run(request);
  const Problem& problem = plan.scene.problem;
  const std::size_t count = problem.lattice.element_count;
  flush_denormals();
  RunResult result = described(plan, request);
  TimedRun timed(plan, request, result);
  timed.run(request.warmup_steps);
  result.model = name(timed.model());
  if (result.status != "ok") return result;
  const Rotation rotation = timed.equations();
  result.max_displacement_m = max_displacement(timed.executor(), count);
  result.digest = state_digest(timed.executor(), count, plan.precision);
  if (count <= energy_elements) result.energy_j = total_energy(problem, whole_state(timed.executor(), count), rotation);
  if (result.model_report.promotions.empty()) result.energy_drift = energy_drift(problem, rotation, result.energy_j);
  if (!request.state_csv.empty()) {
    const std::vector<double> state = whole_state(timed.executor(), count);
    const WorkAlone alone(timed.executor(), request.is_root);
    if (request.is_root) write_state(request.state_csv, problem, state, timed.equations());
    result.files.push_back(request.state_csv);
  }
  result.wall_s += result.model_report.look_s;
  judge(result.check, result);
  if (result.status == "ok") timed.repeat(request.repeat_for);
  return result;
}

} // namespace dss
