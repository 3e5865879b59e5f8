#include "experiments/run/ensemble/ensemble_run.hpp"

#include "experiments/base/clock.hpp"
#include "experiments/run/ensemble/ensemble_passes.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/rank_sums.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "experiments/run/timed/verdict.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {

EnsembleRun::TriedFor EnsembleRun::tried_for(const RunPlan& plan) {
  return {plan.model, plan.method->name, plan.method->stages};
}

EnsembleRun::EnsembleRun(const RunRequest& request)
    : request_(request), plan_(plan_ensemble(request)) {
  for (std::size_t m = 0; m < plan_.members.size(); ++m)
    members_.push_back(std::make_unique<MemberRun>(plan_.plans[m], plan_.requests[m]));
  whole_ = members_.front()->result();
  whole_.elements = whole_.links = 0;
  for (const auto& member : members_) {
    whole_.elements += member->result().elements;
    whole_.links += member->result().links;
  }
  const auto start = Clock::now();
  make_batches();
  batches_.front()->restart();
  batches_.front()->prepare(1);
  batches_.front()->advance();
  whole_.first_step_s = seconds_since(start);
  describe_executors();
}

void EnsembleRun::make_batches() {
  const std::size_t count = plan_.batches.size();
  batch_of_.resize(members_.size());
  // Threads divide batches. A single batch, or a batch of several ranks, is divided like a body,
  // unless extra links join distant rows of its threads.
  const Plugin& plugin = *plan_.plans.front().plugin;
  const bool is_team = plugin.ensemble_lanes != nullptr && !plugin.is_distributed;
  team_ = is_team ? int(std::min(count, std::size_t(request_.threads))) : 1;
  for (const auto& [members, has_lanes] : plan_.batches) {
    std::vector<const RunPlan*> plans;
    for (const std::size_t m : members) plans.push_back(&plan_.plans[m]);
    RunPlan& plan = plan_.plans[members.front()];
    const bool has_packs = has_lanes && plan_.lanes > request_.ranks,
               is_divided = (!is_team || count == 1) &&
                            !(has_packs && !plan.scene.problem.extra_links.empty());
    const auto tried = tried_halos_.find(tried_for(plan));
    if (!has_lanes && tried != tried_halos_.end()) plan.distribution.halo = tried->second.halo;
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
        std::make_unique<MemberBatch>(std::move(plans), has_lanes ? plan_.lanes : 1, setup));
    // Batches in lanes exchange no halos; a hybrid has a strategy of its own.
    const RankInfo info = rank_info(batches_.back()->executor());
    if (!has_lanes && request_.hybrid.empty() && !info.halo.empty())
      tried_halos_.try_emplace(tried_for(plan), info);
    for (const std::size_t m : members) batch_of_[m] = batches_.back().get();
  }
}

void EnsembleRun::describe_executors() {
  describe_executor(batches_.front()->executor(), *plan_.plans.front().plugin, whole_);
  whole_.bytes = 0;
  for (const auto& batch : batches_) whole_.bytes += batch->executor().bytes();
  whole_.workers = std::max(whole_.workers, team_);
  if (plan_.lanes == 1) return;
  const auto alone = std::ranges::count(plan_.batches, false, &BatchPlan::has_lanes);
  const auto counted = [](std::size_t count, const char* what, const char* plural) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : plural);
  };
  whole_.schedule += fmt::format(", {} in {}", counted(members_.size(), "member", "s"),
                                 counted(batches_.size(), "batch", "es"));
  if (alone > 0) whole_.schedule += fmt::format(", {} of one member by itself", alone);
}

Usage EnsembleRun::metered(const std::function<void()>& work) {
  const UsageMeter meter;
  usage_ = {};
  work();
  return of_all_ranks(batches_.front()->executor(), team_ == 1 ? usage_ : meter.read());
}

double EnsembleRun::steps_of_batches() const {
  double steps = 0;
  for (const auto& batch : batches_) steps += double(batch->step());
  return steps;
}

Traffic EnsembleRun::sent() const {
  Traffic all;
  for (const auto& batch : batches_) {
    const Traffic own = traffic(batch->executor());
    all = {all.messages + own.messages, all.bytes + own.bytes, all.wait_s + own.wait_s};
  }
  return all;
}

template <class Visit>
void EnsembleRun::each_member(Visit&& visit) {
  for (std::size_t b = 0; b < batches_.size(); ++b)
    for (std::size_t n = 0; n < batches_[b]->size(); ++n)
      visit(*members_[plan_.batches[b].members[n]], batches_[b]->state(n),
            !batches_[b]->failure(n));
}

std::uint64_t EnsembleRun::digest_of_all() {
  StateDigest all(plan_.plans.front().precision);
  each_member([&](const MemberRun&, std::span<const double> state, bool is_alive) {
    if (is_alive) all.add(state);
  });
  return all.value();
}

bool EnsembleRun::is_balanced_by_steps() const {
  return members_.front()->has_balance() &&
         dss::is_balanced_by_steps(whole_.elements, whole_.steps);
}

void EnsembleRun::run() {
  try {
    warm_up();
    const Traffic before = sent();
    whole_.usage = metered(
        [&] { whole_.wall_s = request_.has_checkpoint() ? saved_pass() : pass(Looks::at_stops); });
    put_traffic(batches_.front()->executor(), since(before, sent()),
                steps_of_batches() - steps_before_, whole_);
    whole_.digest = digest_of_all();
    each_member([](MemberRun& member, std::span<const double> state, bool) {
      if (member.is_ok()) member.end(state);
    });
    if (are_all_ok() && is_balanced_by_steps() && whole_.resumed_step == 0) {
      for (const auto& member : members_) member->begin_steps();
      pass(Looks::at_steps);
    }
    each_member([](MemberRun& member, std::span<const double> state, bool) {
      if (member.is_ok()) member.judge(state);
    });
  } catch (...) { // no partial results, unless the run can go on with them
    for (const auto& member : members_)
      if (!request_.has_checkpoint()) member->discard_files();
    throw;
  }
  if (are_all_ok()) take_samples(whole_.wall_s);
}

void EnsembleRun::take_samples(double first_s) {
  const double least_s = request_.repeat_for;
  whole_.samples = request_.samples;
  for (long taken = first_s < least_s ? 0 : 1; taken < request_.samples; ++taken) {
    double wall_s = 0;
    long runs = 0;
    const Usage usage = metered([&] {
      do {
        wall_s += pass(Looks::none);
        ++runs;
      } while (wall_s < least_s);
    });
    wall_s /= double(runs);
    if (digest_of_all() != whole_.digest) {
      whole_.status = "wrong";
      whole_.reason = "the bits of a later run from the same state are not those of the first";
      return;
    }
    if (taken > 0 && wall_s >= whole_.wall_s) continue;
    whole_.wall_s = wall_s, whole_.usage = usage, whole_.runs = runs;
  }
}

EnsembleResult EnsembleRun::result() const {
  EnsembleResult result{whole_, {}, batches_.size(), plan_.lanes};
  RunResult& whole = result.whole;
  whole.max_displacement_m = 0;
  whole.element_steps = 0;
  std::size_t failed = 0;
  std::string failures;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    RunResult own = members_[m]->result();
    describe_executor(batch_of_[m]->executor(), *plan_.plans[m].plugin, own);
    const auto tried = tried_halos_.find(tried_for(plan_.plans[m]));
    if (tried != tried_halos_.end() && tried->second.halo == own.ranks.halo)
      own.ranks.halo_reason = tried->second.halo_reason, own.ranks.network = tried->second.network;
    own.workers = whole.workers, own.wall_s = whole.wall_s;
    own.usage = whole.usage, own.messages_per_step = whole.messages_per_step;
    own.bytes_per_step = whole.bytes_per_step;
    own.communication_share = whole.communication_share;
    own.samples = whole.samples, own.runs = whole.runs;
    add_member(own, whole);
    if (own.status != "ok") {
      constexpr std::size_t most_named = 3;
      if (whole.status == "ok" || own.status == "unstable") whole.status = own.status;
      if (++failed <= most_named)
        failures += fmt::format("; member {}: {}", plan_.members[m].name, own.reason);
      else if (failed == most_named + 1)
        failures += "; and so on";
    }
    result.members.push_back({plan_.members[m], std::move(own)});
  }
  if (failed > 0)
    whole.reason = fmt::format("{} of {} members failed{}", failed, members_.size(), failures);
  return result;
}

EnsembleResult run_ensemble(const RunRequest& request) {
  EnsembleRun ensemble(request);
  ensemble.run();
  return ensemble.result();
}

} // namespace dss
