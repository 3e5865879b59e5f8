#include "experiments/run/ensemble/ensemble_checkpoint.hpp"

#include "experiments/base/progress.hpp"
#include "experiments/run/checkpoint/saving.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/digest.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

nlohmann::ordered_json head_of(std::size_t member, const MemberRun& run, const MemberBatch& batch) {
  nlohmann::ordered_json head = {
      {"member", member}, {"step", batch.step()}, {"is_done", batch.is_done()}};
  if (!run.is_ok())
    head["failure"] = {{"steps", run.result().steps}, {"reason", run.result().reason}};
  head["history"] = run.history_columns();
  return head;
}

long whole_of(const nlohmann::json& head, const char* key) {
  const long number = whole_number(head.at(key));
  if (number < 0) throw std::out_of_range(key);
  return number;
}

/// @throws nlohmann::json::exception, std::out_of_range if a head or a block is of no such member
void read_member(const nlohmann::json& head, BlockReader& file, std::size_t elements,
                 std::size_t width, std::vector<MemberStanding>& members) {
  MemberStanding& standing = members.at(std::size_t(whole_of(head, "member")));
  if (standing.failure || !standing.kept.empty()) throw std::out_of_range("twice");
  standing.step = whole_of(head, "step");
  if (const auto failure = head.find("failure"); failure != head.end()) {
    standing.failure = {whole_of(*failure, "steps"), failure->at("reason").get<std::string>()};
    return;
  }
  standing.kept = file.next();
  if (head.at("is_done").get<bool>()) standing.end = file.next();
  standing.history.columns = head.value("history", "");
  if (!standing.history.columns.empty()) standing.history.numbers = file.next();
  if (standing.kept.size() != elements * width ||
      (!standing.end.empty() && standing.end.size() != elements * field_count))
    throw std::out_of_range("size");
}

} // namespace

RunIdentity identity_of(const EnsemblePlan& plan, bool has_fma, int kept_fields) {
  const auto of_member = [&](std::size_t m) {
    return RunIdentity(plan.requests[m], plan.plans[m], false, has_fma, kept_fields, {}).facts;
  };
  RunIdentity all(plan.requests[0], plan.plans[0], false, has_fma, kept_fields, {});
  std::string members;
  for (std::size_t m = 0; m < plan.members.size(); ++m) {
    members += plan.members[m].name + ' ';
    if (m == 0) members += all.facts["problem"].dump() + all.facts["dt_s"].dump();
    if (m == 0 || (plan.members[m].set.empty() && plan.members[0].set.empty())) continue;
    const nlohmann::ordered_json facts = of_member(m);
    for (const auto& [key, value] : facts.items())
      if (value != all.facts[key]) members += key + value.dump();
  }
  all.facts["members"] = plan.members.size();
  all.facts["problem"] = text_digest(members);
  return all;
}

std::string write_ensemble(const std::string& path, const RunIdentity& identity,
                           const EnsemblePlan& plan, Batches batches, MemberRuns members,
                           bool is_root) {
  nlohmann::ordered_json head = identity.facts;
  const auto members_of = [&](std::size_t b) -> const std::vector<std::size_t>& {
    return plan.batches[b].members;
  };
  long step = 0;
  for (const auto& batch : batches) step = std::max(step, batch->step());
  head["step"] = step;
  head["standing"] = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < batches.size(); ++b)
    for (std::size_t n = 0; n < batches[b]->size(); ++n)
      head["standing"].push_back(
          head_of(members_of(b)[n], *members[members_of(b)[n]], *batches[b]));
  CheckpointFile file(path, head, batches.front()->executor(), is_root);
  bool is_whole = true;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    const std::vector<std::vector<double>> kept = batches[b]->save();
    for (std::size_t n = 0; n < kept.size(); ++n) {
      if (!members[members_of(b)[n]]->is_ok()) continue;
      is_whole &= all_finite(kept[n]);
      file.write(kept[n]);
      if (batches[b]->is_done()) file.write(batches[b]->state(n));
      const HistoryRows history = members[members_of(b)[n]]->history();
      if (!history.columns.empty()) file.write(history.numbers);
    }
  }
  if (!is_whole) return fmt::format("{}: a state is not finite, so it was not saved", path);
  return file.commit();
}

EnsembleSaving::EnsembleSaving(const RunRequest& request, const EnsemblePlan& plan,
                               const RunIdentity& identity, Batches batches, MemberRuns members,
                               long step)
    : request_(request), plan_(plan), identity_(identity), batches_(batches), members_(members),
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
  return write_ensemble(request_.checkpoint, identity_, plan_, batches_, members_,
                        request_.is_root);
}

void EnsembleSaving::note(const std::string& failure) const {
  if (!failure.empty() && request_.is_root) Progress().note(failure + "; the run goes on");
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
