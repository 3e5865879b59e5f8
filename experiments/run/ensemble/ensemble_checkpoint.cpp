#include "experiments/run/ensemble/ensemble_checkpoint.hpp"

#include "experiments/base/progress.hpp"
#include "experiments/run/checkpoint/saving.hpp"
#include "solver/digest.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

nlohmann::ordered_json head_of(std::size_t member, const MemberBatch& batch, std::size_t lane) {
  nlohmann::ordered_json head = {
      {"member", member}, {"step", batch.step()}, {"is_done", batch.is_done()}};
  if (const auto& failure = batch.failure(lane))
    head["failure"] = {{"step", failure->step}, {"element", failure->element}};
  return head;
}

/// @throws nlohmann::json::exception, std::out_of_range if a head or a block is of no such member
void read_member(const nlohmann::json& head, BlockReader& file, std::size_t elements,
                 std::size_t width, std::vector<MemberStanding>& members) {
  MemberStanding& standing = members.at(head.at("member").get<std::size_t>());
  standing.step = head.at("step").get<long>();
  if (const auto failure = head.find("failure"); failure != head.end()) {
    standing.failure = {false, failure->at("step").get<long>(),
                        failure->at("element").get<std::size_t>()};
    return;
  }
  standing.kept = file.next();
  if (head.at("is_done").get<bool>()) standing.end = file.next();
  if (standing.kept.size() != elements * width ||
      (!standing.end.empty() && standing.end.size() != elements * field_count))
    throw std::out_of_range("size");
}

bool is_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

} // namespace

RunIdentity identity_of(const EnsemblePlan& plan, bool has_fma, int kept_fields) {
  const auto of_member = [&](std::size_t m) {
    return RunIdentity(plan.requests[m], plan.plans[m], false, has_fma, kept_fields, {});
  };
  RunIdentity all = of_member(0);
  std::string problems;
  for (std::size_t m = 0; m < plan.members.size(); ++m) {
    const bool is_as_first = plan.members[m].set.empty() && plan.members.front().set.empty();
    const nlohmann::ordered_json facts = is_as_first ? all.facts : of_member(m).facts;
    problems += fmt::format("{} {} {} ", plan.members[m].name, facts["problem"].dump(),
                            facts["dt_s"].dump());
  }
  all.facts["members"] = plan.members.size();
  all.facts["problem"] = text_digest(problems);
  return all;
}

std::string write_ensemble(const std::string& path, const RunIdentity& identity,
                           const EnsemblePlan& plan, Batches batches, bool is_root) {
  nlohmann::ordered_json head = identity.facts;
  head["standing"] = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < batches.size(); ++b)
    for (std::size_t n = 0; n < batches[b]->size(); ++n)
      head["standing"].push_back(head_of(plan.batches[b].members[n], *batches[b], n));
  CheckpointFile file(path, head, batches.front()->executor(), is_root);
  bool is_whole = true;
  for (const auto& batch : batches) {
    const std::vector<std::vector<double>> kept = batch->save();
    for (std::size_t n = 0; n < kept.size(); ++n) {
      if (batch->failure(n)) continue;
      is_whole &= is_finite(kept[n]);
      file.write(kept[n]);
      if (batch->is_done()) file.write(batch->state(n));
    }
  }
  if (!is_whole) return fmt::format("{}: a state is not finite, so it was not saved", path);
  return file.commit();
}

EnsembleSaving::EnsembleSaving(const RunRequest& request, const EnsemblePlan& plan,
                               const RunIdentity& identity, Batches batches, long step)
    : request_(request), plan_(plan), identity_(identity), batches_(batches),
      clock_(parse_checkpoint_interval(request.checkpoint_every), step) {}

void EnsembleSaving::save_or_end(long step) {
  const Saving saving =
      common_saving(batches_.front()->executor(), clock_.is_due(step), interrupts_.is_asked());
  if (saving == Saving::none) return;
  const std::string failure = save(step);
  if (saving == Saving::save_and_end) end_saved(interrupts_, failure, step, request_.checkpoint);
  note(failure);
}

void EnsembleSaving::save_end(long step) { note(save(step)); }

std::string EnsembleSaving::save(long step) {
  clock_.take(step);
  return write_ensemble(request_.checkpoint, identity_, plan_, batches_, request_.is_root);
}

void EnsembleSaving::note(const std::string& failure) const {
  if (!failure.empty()) Progress().note(failure + "; the run goes on");
}

std::vector<MemberStanding> read_ensemble(const std::string& path, const RunIdentity& identity,
                                          const EnsemblePlan& plan) {
  BlockReader file(path);
  if (file.head().value("members", nlohmann::json()) == 0)
    throw InputError(fmt::format("{}: it is of a run by itself; leave --ensemble out", path));
  identity.require_same(path, file.head());
  const std::size_t elements = plan.plans.front().scene.problem.lattice.element_count,
                    width = identity.facts.at("kept_fields").get<std::size_t>();
  std::vector<MemberStanding> members(plan.members.size());
  try {
    for (const nlohmann::json& head : file.head().at("standing"))
      read_member(head, file, elements, width, members);
    file.require_end();
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{}: its head lacks a key; take an earlier file", path));
  } catch (const std::out_of_range&) {
    throw InputError(fmt::format("{}: it has other members; take an earlier file", path));
  }
  if (!std::ranges::all_of(members,
                           [](const MemberStanding& m) { return m.failure || !m.kept.empty(); }))
    throw InputError(fmt::format("{}: it lacks a member; take an earlier file", path));
  return members;
}

} // namespace dss
