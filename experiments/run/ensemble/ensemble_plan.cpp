#include "experiments/run/ensemble/ensemble_plan.hpp"

#include "experiments/run/checkpoint/checkpoint_plan.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/decomposition/decomposition_file.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/memory.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

[[noreturn]] void refuse(const RunRequest& request, const std::string& what) {
  throw InputError(fmt::format("--ensemble {}: {}", request.ensemble, what));
}

/// Refuses options of a single run that members do not take.
void require_plain(const RunRequest& request, const std::vector<MemberSet>& members) {
  if (request.rtol)
    refuse(request, "members take equal steps; give --steps and --dt in place of --rtol");
  const bool are_equal =
      std::ranges::all_of(members, [](const MemberSet& member) { return member.set.empty(); });
  if (!request.reference.empty() || (!request.check_state.empty() && !are_equal))
    refuse(request, "a state or a solution belongs to one run; leave --check-state and "
                    "--reference out");
  if (request.is_root && !request.json.empty() && request.json != "-")
    require_writable(request.json);
}

/// The file of a member: F.vtu becomes F-NAME.vtu.
std::string file_of(const std::string& path, const std::string& member) {
  if (path.empty()) return path;
  const std::filesystem::path whole = path;
  return (whole.parent_path() /
          fmt::format("{}-{}{}", whole.stem().string(), member, whole.extension().string()))
      .string();
}

RunRequest request_of(const RunRequest& request, const MemberSet& member) {
  RunRequest own = request;
  own.is_member = true;
  own.overrides.insert(own.overrides.end(), member.set.begin(), member.set.end());
  own.output = file_of(request.output, member.name);
  own.state_csv = file_of(request.state_csv, member.name);
  own.picture = file_of(request.picture, member.name);
  own.history = file_of(request.history, member.name);
  own.json.clear();
  return own;
}

/// Each member keeps its state in its batch, as it was read, and in its balance of the energy. One
/// that is saved keeps up to 52 numbers an element besides.
void require_room(const RunRequest& request, std::size_t members, std::size_t elements) {
  const double states = request.has_checkpoint() ? 10 : 6;
  require_memory(
      states * double(members) * double(elements) * double(field_count * sizeof(double)),
      fmt::format("--ensemble {}: {} members of {} elements", request.ensemble, members, elements),
      "give fewer");
}

/// The plan of a member. Equal members share what was planned for the first.
RunPlan plan_of(const RunRequest& own, const MemberSet& member, const EnsemblePlan& before) {
  if (!before.plans.empty() && member.set.empty() && before.members.front().set.empty()) {
    if (own.is_root) require_outputs_writable(own);
    return before.plans.front();
  }
  RunPlan plan = plan_run(own);
  require_finite_start(plan.scene.problem, Rotation::quaternion);
  if (before.plans.empty()) return plan;
  const std::string why =
      why_other_topology(before.plans.front().scene.problem, plan.scene.problem);
  if (!why.empty())
    throw InputError(fmt::format("{} as member {} has; members have the same elements and links",
                                 why, before.members.front().name));
  return plan;
}

/// Ranks divide each member that does not lie in a lane.
void require_division(const RunRequest& request, const EnsemblePlan& plan) {
  if (request.ranks > 1 && !std::ranges::all_of(plan.batches, &BatchPlan::has_lanes))
    decomposition_for(plan.plans.front().scene.problem, request.decomposition, request.ranks);
}

} // namespace

EnsemblePlan plan_ensemble(const RunRequest& request) {
  EnsemblePlan plan;
  plan.members = read_members(request.ensemble);
  require_plain(request, plan.members);
  plan.plans.reserve(plan.members.size());
  for (const MemberSet& member : plan.members) {
    const auto place = [&](const std::string& what) {
      return fmt::format("{}: member {}: {}", request.ensemble, member.name, what);
    };
    plan.requests.push_back(request_of(request, member));
    try {
      plan.plans.push_back(plan_of(plan.requests.back(), member, plan));
    } catch (const InputError& error) {
      throw InputError(place(error.what()));
    } catch (const UnstableError& error) {
      throw UnstableError(place(error.what()));
    }
    if (plan.plans.size() == 1)
      require_room(request, plan.members.size(),
                   plan.plans.front().scene.problem.lattice.element_count);
  }
  const Plugin& plugin = *plan.plans.front().plugin;
  if (plugin.ensemble_lanes != nullptr && request.hybrid.empty())
    plan.lanes =
        plugin.ensemble_lanes(plan.plans.front().precision, plan.plans.front().distribution);
  plan.batches = group_members(plan.plans, plan.lanes, request.ranks);
  require_division(request, plan);
  require_sound_checkpoints(request, plan.plans.front());
  return plan;
}

} // namespace dss
