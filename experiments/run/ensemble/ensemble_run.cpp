#include "experiments/run/ensemble/ensemble_run.hpp"

#include "experiments/base/clock.hpp"
#include "experiments/base/parallel.hpp"
#include "experiments/run/ensemble/ensemble_plan.hpp"
#include "experiments/run/ensemble/member_batch.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "experiments/run/timed/oracle_check.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/run_record.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/model/rotation_vector.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

/// What happens to one member on the way.
struct MemberRun {
  MemberRun(const RunPlan& of, const RunRequest& asked)
      : plan(of), request(asked), result(described(of, asked)),
        series(asked.is_root ? asked.output : "", of.frame_steps.size() > 1), oracle_check(of) {}
  Rotation equations() const {
    return plan.rotation == Rotation::quaternion ? rotation_of(plan.model) : plan.rotation;
  }
  bool has_balance() const {
    return request.has_balance && equations() != Rotation::small &&
           plan.scene.problem.lattice.element_count <= balanced_elements;
  }
  void look(std::span<const double> state, long step);
  void fail(const Outcome& failure);
  void end(const std::vector<double>& state);

  const RunPlan& plan;
  const RunRequest& request;
  RunResult result;
  FrameSeries series;
  OracleCheck oracle_check;
  std::optional<EnergyBalance> balance;
};

void MemberRun::look(std::span<const double> state, long step) {
  const Problem& problem = plan.scene.problem;
  const double time = double(step) * plan.dt;
  if (step == 0 && has_balance()) balance.emplace(problem, equations(), state, time, false);
  const long between = energy_look_interval(problem.lattice.element_count, plan.steps);
  if (balance && step > 0 && (step % between == 0 || step == plan.steps))
    balance->look(state, time);
  if (oracle_check.is_wanted(step)) oracle_check.look(step, state, equations(), result.check);
  if (std::ranges::binary_search(plan.frame_steps, step))
    series.add(problem, {state.begin(), state.end()}, equations(), time);
}

void MemberRun::fail(const Outcome& failure) {
  series.discard();
  result.status = "unstable";
  result.steps = failure.step + 1;
  result.reason =
      fmt::format("{}; take --dt below {:.6g} s",
                  breakdown_text(failure.what, failure.step, plan.dt, failure.element),
                  plan.dt > plan.stability_limit ? plan.stability_limit : 0.5 * plan.dt);
}

void MemberRun::end(const std::vector<double>& state) {
  result.max_displacement_m = max_displacement(state);
  StateDigest digest(plan.precision);
  digest.add(state);
  result.digest = digest.value();
  if (plan.scene.problem.lattice.element_count <= energy_elements)
    describe_state(plan, equations(), state, result);
  judge_range(plan, equations(), result);
  if (result.status != "ok") return;
  if (!request.state_csv.empty() && request.is_root) {
    write_state(request.state_csv, plan.scene.problem, state, equations());
    result.files.push_back(request.state_csv);
  }
  if (const std::string written = series.finish(); !written.empty())
    result.files.push_back(written);
  if (balance) result.balance = balance->shares();
  judge_check(result);
  judge_energy(plan, result);
}

/// All batches of an ensemble and what they are timed with.
class EnsembleRun {
public:
  explicit EnsembleRun(const RunRequest& request);
  void run();
  EnsembleResult result();

private:
  void make_batches();
  void warm_up();
  /// Runs a batch from the start to the end. @return the time in advance() [s]
  double run_batch(std::size_t b, bool is_looked_at);
  double run_to(MemberBatch& batch, long stop);
  void look(std::size_t b);
  std::vector<long> stops(std::size_t b) const;
  /// Runs all batches. @return the time of the busiest thread [s]
  double pass(bool is_looked_at);
  void take_samples(double first_s);
  std::uint64_t digest_of_all();

  const RunRequest& request_;
  const EnsemblePlan plan_;
  std::vector<std::unique_ptr<MemberRun>> members_;
  std::vector<std::unique_ptr<MemberBatch>> batches_;
  int team_ = 1; ///< threads that take batches
  RunResult whole_;
};

EnsembleRun::EnsembleRun(const RunRequest& request)
    : request_(request), plan_(plan_ensemble(request)) {
  for (std::size_t m = 0; m < plan_.members.size(); ++m)
    members_.push_back(std::make_unique<MemberRun>(plan_.plans[m], plan_.requests[m]));
  whole_ = members_.front()->result;
  whole_.elements = whole_.links = 0;
  for (const auto& member : members_) {
    whole_.elements += member->result.elements;
    whole_.links += member->result.links;
  }
  const auto start = Clock::now();
  make_batches();
  whole_.first_step_s = seconds_since(start);
}

void EnsembleRun::make_batches() {
  const RunPlan& first = plan_.plans.front();
  const std::size_t count = plan_.batches.size();
  // Threads divide batches. Only a single batch is divided like a body, unless extra links join
  // distant rows of its threads.
  const bool is_of_engine = first.plugin->ensemble_lanes != nullptr;
  team_ = is_of_engine ? int(std::min(count, std::size_t(request_.threads))) : 1;
  for (const std::vector<std::size_t>& batch : plan_.batches) {
    std::vector<const RunPlan*> plans;
    for (const std::size_t m : batch) plans.push_back(&plan_.plans[m]);
    const RunPlan& plan = *plans.front();
    const bool is_divided =
        !is_of_engine ||
        (count == 1 && (batch.size() == 1 || plan.scene.problem.extra_links.empty()));
    const Setup setup{plan.scene.problem,
                      *plan.method,
                      plan.model,
                      plan.precision,
                      plan.dt,
                      is_divided ? request_.threads : 1,
                      nullptr,
                      &plan.distribution,
                      request_.device,
                      request_.hybrid,
                      plan.rotation,
                      request_.tile};
    batches_.push_back(
        std::make_unique<MemberBatch>(std::move(plans), batch.size() > 1 ? plan_.lanes : 1, setup));
    whole_.bytes += batches_.back()->executor().bytes();
    whole_.workers = std::max(whole_.workers, batches_.back()->executor().workers());
  }
  whole_.workers = std::max(whole_.workers, team_);
  whole_.schedule = batches_.front()->executor().schedule();
  if (plan_.lanes > 1)
    whole_.schedule += fmt::format(", {} members in {} batches", members_.size(), count);
}

std::vector<long> EnsembleRun::stops(std::size_t b) const {
  const RunPlan& plan = plan_.plans[plan_.batches[b].front()];
  std::vector<long> steps = members_[plan_.batches[b].front()]->oracle_check.stops();
  steps.insert(steps.end(), plan.frame_steps.begin(), plan.frame_steps.end());
  const long between = energy_look_interval(plan.scene.problem.lattice.element_count, plan.steps);
  for (long step = between; step < plan.steps && request_.has_balance; step += between)
    steps.push_back(step);
  steps.push_back(plan.steps);
  std::ranges::sort(steps);
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  std::erase(steps, 0);
  return steps;
}

double EnsembleRun::run_to(MemberBatch& batch, long stop) {
  double wall_s = 0;
  while (batch.step() < stop && batch.is_alive()) {
    batch.prepare(std::min(signal_steps, stop - batch.step()));
    const auto start = Clock::now();
    batch.advance();
    wall_s += seconds_since(start);
  }
  return wall_s;
}

void EnsembleRun::look(std::size_t b) {
  MemberBatch& batch = *batches_[b];
  for (std::size_t n = 0; n < batch.size(); ++n) {
    MemberRun& member = *members_[plan_.batches[b][n]];
    if (member.result.status != "ok") continue;
    if (batch.failure(n)) {
      member.fail(*batch.failure(n));
      continue;
    }
    const std::span<const double> state = batch.state(n);
    // Numbers that overflow in the last step before a pause.
    if (const auto element = first_not_finite(state))
      member.fail({false, batch.step() - 1, *element});
    else
      member.look(state, batch.step());
  }
}

double EnsembleRun::run_batch(std::size_t b, bool is_looked_at) {
  const FlushDenormals guard;
  MemberBatch& batch = *batches_[b];
  batch.restart();
  if (is_looked_at) look(b);
  double wall_s = 0;
  for (const long stop : stops(b)) {
    wall_s += run_to(batch, stop);
    if (is_looked_at) look(b);
  }
  return wall_s;
}

double EnsembleRun::pass(bool is_looked_at) {
  std::vector<double> busy_s(std::size_t(team_), 0.0);
  for_each_on_team(team_, batches_.size(), [&](std::size_t b, std::size_t thread) {
    busy_s[thread] += run_batch(b, is_looked_at);
  });
  return std::ranges::max(busy_s);
}

void EnsembleRun::warm_up() {
  const long steps = request_.warmup_steps;
  const double least_s = whole_.workers > 1 ? request_.warmup_s : 0;
  const auto start = Clock::now();
  for (bool is_wanted = steps > 0; is_wanted; is_wanted = seconds_since(start) < least_s)
    for_each_on_team(team_, batches_.size(), [&](std::size_t b, std::size_t) {
      const FlushDenormals guard;
      batches_[b]->restart();
      run_to(*batches_[b], steps);
    });
}

std::uint64_t EnsembleRun::digest_of_all() {
  StateDigest all(plan_.plans.front().precision);
  for (std::size_t b = 0; b < batches_.size(); ++b)
    for (std::size_t n = 0; n < batches_[b]->size(); ++n)
      if (!batches_[b]->failure(n)) all.add(batches_[b]->state(n));
  return all.value();
}

void EnsembleRun::run() {
  warm_up();
  const UsageMeter usage;
  whole_.wall_s = pass(true);
  whole_.usage = usage.read();
  whole_.digest = digest_of_all();
  const auto has_ended = [](const auto& member) { return member->result.status == "ok"; };
  for (std::size_t b = 0; b < batches_.size(); ++b)
    for (std::size_t n = 0; n < batches_[b]->size(); ++n) {
      MemberRun& member = *members_[plan_.batches[b][n]];
      const std::span<const double> state = batches_[b]->state(n);
      if (has_ended(&member)) member.end({state.begin(), state.end()});
    }
  if (std::ranges::all_of(members_, has_ended)) take_samples(whole_.wall_s);
}

void EnsembleRun::take_samples(double first_s) {
  const double least_s = request_.repeat_for;
  whole_.samples = request_.samples;
  long taken = first_s < least_s ? 0 : 1;
  for (; taken < request_.samples; ++taken) {
    const UsageMeter usage;
    double wall_s = 0;
    long runs = 0;
    do {
      wall_s += pass(false);
      ++runs;
    } while (wall_s < least_s);
    wall_s /= double(runs);
    if (digest_of_all() != whole_.digest) {
      whole_.status = "wrong";
      whole_.reason = "the bits of a later run from the same state are not those of the first";
      return;
    }
    if (taken > 0 && wall_s >= whole_.wall_s) continue;
    whole_.wall_s = wall_s, whole_.usage = usage.read(), whole_.runs = runs;
  }
}

/// Of several members the largest errors count.
void add_check(const CheckResult& own, CheckResult& all) {
  if (!own.is_done) return;
  const CheckResult before = all;
  all = own;
  if (!before.is_done) return;
  all.error = std::max(all.error, before.error);
  if (all.tail_error && before.tail_error)
    all.tail_error = std::max(*all.tail_error, *before.tail_error);
}

EnsembleResult EnsembleRun::result() {
  EnsembleResult result{whole_, {}, batches_.size(), plan_.lanes};
  RunResult& whole = result.whole;
  whole.max_displacement_m = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    RunResult own = members_[m]->result;
    own.schedule = whole.schedule, own.workers = whole.workers, own.wall_s = whole.wall_s;
    own.samples = whole.samples, own.runs = whole.runs;
    whole.max_displacement_m = std::max(whole.max_displacement_m, own.max_displacement_m);
    whole.files.insert(whole.files.end(), own.files.begin(), own.files.end());
    add_check(own.check, whole.check);
    if (own.status != "ok" && (whole.status == "ok" || own.status == "unstable"))
      whole.status = own.status;
    result.members.push_back({plan_.members[m], std::move(own)});
  }
  return result;
}

} // namespace

EnsembleResult run_ensemble(const RunRequest& request) {
  EnsembleRun ensemble(request);
  ensemble.run();
  return ensemble.result();
}

nlohmann::ordered_json ensemble_json(const RunRequest& request, const EnsembleResult& result) {
  nlohmann::ordered_json json = run_json(request, result.whole);
  json["batches"] = result.batches;
  json["lanes"] = result.lanes;
  json["members"] = nlohmann::ordered_json::array();
  for (const MemberResult& member : result.members) {
    nlohmann::ordered_json own = {{"name", member.member.name},
                                  {"set", nlohmann::ordered_json::object()}};
    for (const Override& item : member.member.set) own["set"][item.key] = item.value;
    own.update(run_json(member.result));
    json["members"].push_back(std::move(own));
  }
  return json;
}

} // namespace dss
