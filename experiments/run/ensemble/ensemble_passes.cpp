#include "experiments/run/ensemble/ensemble_passes.hpp"

#include "experiments/base/clock.hpp"
#include "experiments/base/parallel.hpp"
#include "experiments/run/checkpoint/saving.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/error.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {

std::vector<long> EnsembleRun::stops(std::size_t b, Looks looks) const {
  const RunPlan& plan = plan_.plans[plan_.batches[b].members.front()];
  std::vector<long> steps{plan.steps};
  if (looks == Looks::at_steps)
    for (long step = 1; step < plan.steps; ++step) steps.push_back(step);
  if (looks == Looks::at_stops) {
    const MemberRun& member = *members_[plan_.batches[b].members.front()];
    const std::vector<long> checks = member.oracle_check().stops();
    steps.insert(steps.end(), checks.begin(), checks.end());
    steps.insert(steps.end(), plan.frame_steps.begin(), plan.frame_steps.end());
    steps.insert(steps.end(), plan.history_steps.begin(), plan.history_steps.end());
    const long between = energy_look_interval(plan.scene.problem.lattice.element_count, plan.steps);
    for (long step = between; step < plan.steps && member.has_balance(); step += between)
      steps.push_back(step);
  }
  std::ranges::sort(steps);
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  std::erase(steps, 0);
  return steps;
}

double EnsembleRun::run_to(MemberBatch& batch, long stop) {
  double wall_s = 0;
  std::optional<UsageMeter> meter;
  if (team_ == 1) meter.emplace();
  while (batch.step() < stop && batch.is_alive()) {
    batch.prepare(std::min(signal_steps, stop - batch.step()));
    if (plan_.plans.front().plugin->is_distributed) gather(batch.executor(), 0); // all start
    const auto start = Clock::now();
    batch.advance();
    wall_s += seconds_since(start);
  }
  if (meter) usage_ += meter->read();
  return wall_s;
}

void EnsembleRun::tell_failures(std::size_t b) {
  for (std::size_t n = 0; n < batches_[b]->size(); ++n) {
    MemberRun& member = *members_[plan_.batches[b].members[n]];
    if (const auto& failure = batches_[b]->failure(n); failure && member.is_ok())
      member.fail(*failure);
  }
}

void EnsembleRun::look(std::size_t b, Looks looks) {
  MemberBatch& batch = *batches_[b];
  batch.read(); // all ranks take part
  const WorkAlone alone(batch.executor(), request_.is_root);
  for (std::size_t n = 0; n < batch.size(); ++n) {
    MemberRun& member = *members_[plan_.batches[b].members[n]];
    if (!member.is_ok()) continue;
    const std::span<const double> state = batch.state(n);
    // Numbers that overflow in the last step before a pause.
    if (const auto element = first_not_finite(state))
      member.fail({false, batch.step() - 1, *element});
    else if (looks == Looks::at_steps)
      member.look_at_step(state, batch.step());
    else
      member.look(state, batch.step());
    if (!member.is_ok()) batch.fail(n);
  }
}

void EnsembleRun::begin(std::size_t b, Looks looks) {
  batches_[b]->restart();
  if (looks == Looks::at_stops) look(b, looks);
}

double EnsembleRun::go_on(std::size_t b, Looks looks, long until) {
  MemberBatch& batch = *batches_[b];
  double wall_s = 0;
  for (const long stop : stops(b, looks)) {
    if (stop <= batch.step()) continue;
    wall_s += run_to(batch, std::min(stop, until));
    if (looks != Looks::none) tell_failures(b);
    if (stop > until || !batch.is_alive()) break;
    if (looks != Looks::none) look(b, looks);
  }
  return wall_s;
}

double EnsembleRun::on_team(const std::function<double(std::size_t)>& work) {
  std::vector<double> busy_s(std::size_t(team_), 0.0);
  for_each_on_team(team_, batches_.size(), [&](std::size_t b, std::size_t thread) {
    const FlushDenormals guard;
    busy_s[thread] += work(b);
  });
  return std::ranges::max(busy_s);
}

double EnsembleRun::pass(Looks looks) {
  return on_team([&](std::size_t b) {
    begin(b, looks);
    return go_on(b, looks, last_step());
  });
}

long EnsembleRun::last_step() const {
  return std::ranges::max(plan_.plans, {}, &RunPlan::steps).steps;
}

double EnsembleRun::saved_pass() {
  const int width = kept_fields(batches_.front()->executor());
  if (width == 0) refuse_saving(request_, whole_.variant);
  const auto is_alike = [&](const auto& batch) { return kept_fields(batch->executor()) == width; };
  if (!std::ranges::all_of(batches_, is_alike))
    throw InputError("--checkpoint: members of different methods keep different numbers; run those "
                     "of each method as an ensemble of their own");
  const RunIdentity identity = identity_of(plan_, whole_.has_fma, width);
  for (const auto& member : members_) member->keep_frames();
  long step = 0;
  if (!request_.restart.empty())
    step = resume(identity);
  else
    on_team([&](std::size_t b) { return begin(b, Looks::at_stops), 0.0; });
  std::optional<EnsembleSaving> saving;
  if (!request_.checkpoint.empty())
    saving.emplace(request_, plan_, identity, batches_, members_, step);
  const long pause = steps_of_pause(double(whole_.elements) / double(team_)), last = last_step();
  double wall_s = 0;
  while (step < last) {
    step = saving ? saving->next_pause(step, std::min(last, step + pause)) : last;
    wall_s += on_team([&](std::size_t b) { return go_on(b, Looks::at_stops, step); });
    if (saving && step < last) saving->save_or_end(step);
  }
  if (saving) saving->save_end(step);
  return wall_s;
}

long EnsembleRun::resume(const RunIdentity& identity) {
  const std::vector<MemberStanding> members = read_ensemble(request_.restart, identity, plan_);
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    std::vector<const MemberStanding*> own;
    for (const std::size_t m : plan_.batches[b].members) own.push_back(&members[m]);
    batches_[b]->restore(own);
    whole_.resumed_step = std::max(whole_.resumed_step, batches_[b]->step());
  }
  for (std::size_t m = 0; m < members.size(); ++m) members_[m]->resume(members[m]);
  steps_before_ = steps_of_batches();
  const std::optional<OracleState>& expected = plan_.plans.front().expected;
  if (expected && expected->steps <= whole_.resumed_step)
    refuse_passed_state(request_, expected->steps);
  if (whole_.resumed_step >= last_step())
    throw InputError(
        fmt::format("{}: the ensemble has done all of its {} steps; give more --steps, "
                    "or {} to do the last ones again",
                    request_.restart, whole_.resumed_step, earlier_checkpoint(request_.restart)));
  return whole_.resumed_step;
}

void EnsembleRun::warm_up() {
  const long steps = request_.warmup_steps;
  const double least_s = whole_.workers > 1 ? request_.warmup_s : 0;
  const auto start = Clock::now();
  const auto is_more_wanted = [&] { // all ranks decide by the clock of the first
    return gather(batches_.front()->executor(), seconds_since(start)).front() < least_s;
  };
  for (bool is_wanted = steps > 0; is_wanted; is_wanted = is_more_wanted())
    for_each_on_team(team_, batches_.size(), [&](std::size_t b, std::size_t) {
      const FlushDenormals guard;
      batches_[b]->restart();
      run_to(*batches_[b], steps);
    });
}

} // namespace dss
