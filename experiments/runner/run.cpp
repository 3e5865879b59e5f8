#include "experiments/runner/run.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/output.hpp"
#include "experiments/runner/run_plan.hpp"
#include "experiments/runner/state_access.hpp"
#include "solver/model/energy.hpp"
#include "solver/numerics/denormals.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr long batch_steps = 256;                  ///< signals are made for so many steps at once
constexpr std::size_t energy_elements = 2'000'000; ///< a second copy of a larger state would count in the memory

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
      : plan_(plan), problem_(plan.scene.problem), result_(result),
        executor_(plan.plugin->create({problem_, *plan.method, plan.model, plan.precision, plan.dt, request.threads,
                                       nullptr, &plan.distribution})),
        series_(request.is_root ? request.output : "", plan.frame_steps.size() > 1), is_root_(request.is_root) {}

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
      advance_to(0, warmup_steps, discarded);
    }
    write_initial_state(*executor_, problem_);
    const Traffic before = executor_->traffic();
    long step = 0;
    look(step);
    for (const long stop : stops()) {
      if (!advance_to(step, stop, result_)) return;
      step = stop;
      look(step);
    }
    sum_over_ranks(before);
    if (const std::string written = series_.finish(); !written.empty()) result_.files.push_back(written);
  }

  Executor& executor() { return *executor_; }

private:
  /// Steps at which the run pauses, ascending, the last step among them.
  std::vector<long> stops() const {
    std::vector<long> steps = plan_.frame_steps;
    if (plan_.expected) steps.push_back(plan_.expected->steps);
    if (has_tail()) steps.push_back(tail_start());
    steps.push_back(plan_.steps);
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    std::erase(steps, 0);
    return steps;
  }

  /// A leapfrog cannot start anew from a state without its half-step velocities, so only Runge-Kutta runs have their
  /// ends checked.
  bool has_tail() const {
    return plan_.expected && plan_.expected->steps < plan_.steps && plan_.method->family == Method::Family::runge_kutta;
  }
  long tail_start() const { return std::max(plan_.expected->steps, plan_.steps - tail_steps); }

  bool advance_to(long step, long stop, RunResult& result) {
    bool is_finite = true;
    while (step < stop && is_finite) {
      const long count = std::min(batch_steps, stop - step);
      const std::vector<double> signals = signal_rows(problem_, *plan_.method, plan_.dt, step, count);
      if (plan_.plugin->is_distributed)
        executor_->gather(0); // all ranks begin together: what rank 0 did alone is not timed
      const UsageMeter usage; // over the same region as the clock: CPU / wall is judged
      const auto start = std::chrono::steady_clock::now();
      const Outcome outcome = executor_->advance(count, signals);
      result.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      result.usage += usage.read();
      is_finite = outcome.is_finite;
      if (!is_finite) report_breakdown(step + outcome.step, outcome.element, result);
      step += count;
    }
    return is_finite;
  }

  void sum_over_ranks(const Traffic& before) {
    const auto sum = [&](double value) {
      double total = 0;
      for (const double of_rank : executor_->gather(value)) total += of_rank;
      return total;
    };
    const Traffic now = executor_->traffic();
    const double steps = double(plan_.steps);
    result_.messages_per_step = sum(now.messages - before.messages) / steps;
    result_.bytes_per_step = sum(now.bytes - before.bytes) / steps;
    result_.communication_share = sum(now.wait_s - before.wait_s) / (result_.wall_s * result_.ranks.ranks);
    result_.usage.cpu_s = sum(result_.usage.cpu_s);
    result_.usage.wait_s = sum(result_.usage.wait_s);
    result_.usage.involuntary_switches = long(sum(double(result_.usage.involuntary_switches)));
  }

  void report_breakdown(long step, std::size_t element, RunResult& result) const {
    result.status = "unstable";
    result.steps = step + 1;
    result.reason =
        fmt::format("{}: the state is not finite after step {} (t = {:.6g} s), element {}; take --dt below {:.6g} s",
                    problem_.name, step + 1, double(step + 1) * plan_.dt, element,
                    plan_.dt > plan_.stability_limit ? plan_.stability_limit : 0.5 * plan_.dt);
  }

  void look(long step) {
    const std::size_t count = problem_.lattice.element_count;
    if (plan_.expected && step == plan_.expected->steps) {
      CheckResult& check = result_.check;
      check.is_done = true;
      check.how = fmt::format("oracle after {} steps", step);
      check.tolerance = plan_.tolerance().run;
      const std::vector<double> state = whole_state(*executor_, count);
      const WorkAlone alone(*executor_, is_root_);
      if (is_root_) check.error = state_error(problem_, plan_.expected->state, state);
    }
    if (has_tail() && step == tail_start()) tail_state_ = whole_state(*executor_, count);
    if (has_tail() && step == plan_.steps) check_tail();
    if (std::binary_search(plan_.frame_steps.begin(), plan_.frame_steps.end(), step)) {
      const std::vector<double> state = whole_state(*executor_, count);
      const WorkAlone alone(*executor_, is_root_);
      series_.add(problem_, state, double(step) * plan_.dt);
    }
  }

  void check_tail() {
    const long steps = plan_.steps - tail_start();
    const std::vector<double> state = whole_state(*executor_, problem_.lattice.element_count);
    if (!is_root_) return;
    const WorkAlone alone(*executor_, true);
    const auto expected = continue_by_oracle(problem_, *plan_.method, plan_.dt, tail_start(), steps, tail_state_);
    result_.check.tail_error = state_error(problem_, expected, state);
    result_.check.how += fmt::format(", and over the last {}", steps);
  }

  const RunPlan& plan_;
  const Problem& problem_;
  RunResult& result_;
  std::unique_ptr<Executor> executor_;
  FrameSeries series_;
  bool is_root_;
  std::vector<double> tail_state_;
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
  result.threads = request.threads;
  result.elements = plan.scene.problem.lattice.element_count;
  result.links = plan.scene.problem.link_count();
  result.steps = plan.steps;
  result.warmup_steps = request.warmup_steps;
  result.dt_s = plan.dt;
  result.stability_limit_s = plan.stability_limit;
  return result;
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
  if (result.status != "ok") return result;
  result.max_displacement_m = max_displacement(timed.executor(), count);
  result.digest = state_digest(timed.executor(), count, plan.precision);
  if (count <= energy_elements) result.energy_j = total_energy(problem, whole_state(timed.executor(), count));
  if (!request.state_csv.empty()) {
    const std::vector<double> state = whole_state(timed.executor(), count);
    const WorkAlone alone(timed.executor(), request.is_root);
    if (request.is_root) write_state(request.state_csv, problem, state);
    result.files.push_back(request.state_csv);
  }
  judge(result.check, result);
  return result;
}

nlohmann::ordered_json run_json(const RunRequest& request, const RunResult& result) {
  nlohmann::ordered_json json;
  json["context"] = measurement_context();
  json["scene"] = result.scene;
  json["set"] = nlohmann::ordered_json::object();
  for (const Override& item : request.overrides) json["set"][item.key] = item.value;
  json["variant"] = result.variant;
  json["isa"] = result.isa;
  json["has_fma"] = result.has_fma;
  json["model"] = result.model;
  json["precision"] = result.precision;
  json["integrator"] = result.integrator;
  json["threads"] = result.threads;
  json["workers"] = result.workers;
  json["ranks"] = result.ranks.ranks;
  json["decomposition"] = result.ranks.decomposition;
  json["halo"] = result.ranks.halo;
  json["halo_reason"] = result.ranks.halo_reason;
  const Network& network = result.ranks.network;
  json["network"] = {{"latency_s", network.latency_s},
                     {"seconds_a_byte", network.seconds_a_byte},
                     {"overhead_s", network.overhead_s},
                     {"overhead_s_a_byte", network.overhead_s_a_byte}};
  json["imbalance"] = result.ranks.imbalance;
  json["messages_per_step"] = result.messages_per_step;
  json["bytes_per_step"] = result.bytes_per_step;
  json["communication_share"] = result.communication_share;
  json["elements"] = result.elements;
  json["links"] = result.links;
  json["steps"] = result.steps;
  json["warmup_steps"] = result.warmup_steps;
  json["dt_s"] = result.dt_s;
  json["stability_limit_s"] = result.stability_limit_s;
  json["wall_s"] = result.wall_s;
  json["cpu_s"] = result.usage.cpu_s;
  json["wait_s"] = result.usage.wait_s;
  json["involuntary_switches"] = result.usage.involuntary_switches;
  json["is_contaminated"] = is_contaminated(result.usage, result.wall_s, result.workers);
  json["element_steps_per_s"] = result.element_steps_per_s();
  json["energy_j"] = result.energy_j ? nlohmann::ordered_json(*result.energy_j) : nullptr;
  const bool has_state = result.status != "unstable";
  json["max_displacement_m"] = has_state ? nlohmann::ordered_json(result.max_displacement_m) : nullptr;
  json["state_digest"] = has_state ? nlohmann::ordered_json(fmt::format("{:016x}", result.digest)) : nullptr;
  json["schedule"] = result.schedule;
  json["bytes"] = result.bytes;
  json["check"] = result.check.is_done ? (result.check.is_passed() ? "passed" : "failed") : "none";
  json["check_how"] = result.check.how;
  json["check_tolerance"] = result.check.is_done ? nlohmann::ordered_json(result.check.tolerance) : nullptr;
  json["check_error"] = result.check.is_done ? nlohmann::ordered_json(result.check.error) : nullptr;
  json["check_tail_error"] = result.check.tail_error ? nlohmann::ordered_json(*result.check.tail_error) : nullptr;
  json["status"] = result.status;
  json["reason"] = result.reason;
  return json;
}

} // namespace dss
