#include "experiments/run/ensemble/ensemble_plan.hpp"

#include "experiments/run/ensemble/member_batch.hpp"
#include "solver/error.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace dss {
namespace {

/// Options of a single run that its members do not take.
void require_plain(const RunRequest& request) {
  const auto refuse = [](const std::string& what) { throw InputError("--ensemble: " + what); };
  if (request.rtol) refuse("members take equal steps; give --steps and --dt in place of --rtol");
  if (!request.reference.empty()) refuse("a solution belongs to one run; leave --reference out");
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
  own.json.clear();
  return own;
}

/// Each member keeps its state, and so does its batch.
void require_memory(const RunRequest& request, std::size_t members, std::size_t elements) {
  const double needed =
                   2.0 * double(members) * double(elements) * double(field_count * sizeof(double)),
               machine = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGE_SIZE));
  if (needed > machine)
    throw InputError(fmt::format("{}: {} members of {} elements need {:.3g} GB or more; this "
                                 "machine has {:.3g}; give fewer",
                                 request.ensemble, members, elements, 1e-9 * needed,
                                 1e-9 * machine));
}

} // namespace

EnsemblePlan plan_ensemble(const RunRequest& request) {
  require_plain(request);
  EnsemblePlan plan;
  plan.members = read_members(request.ensemble);
  plan.plans.reserve(plan.members.size());
  for (const MemberSet& member : plan.members) {
    const auto place = [&](const std::string& what) {
      return fmt::format("{}: member {}: {}", request.ensemble, member.name, what);
    };
    plan.requests.push_back(request_of(request, member));
    try {
      plan.plans.push_back(plan_run(plan.requests.back()));
    } catch (const InputError& error) {
      throw InputError(place(error.what()));
    } catch (const UnstableError& error) {
      throw UnstableError(place(error.what()));
    }
    const Problem &first = plan.plans.front().scene.problem, &own = plan.plans.back().scene.problem;
    if (const std::string why = why_other_topology(first, own); !why.empty())
      throw InputError(place(fmt::format("{} as member {} has; members have the same elements and "
                                         "links",
                                         why, plan.members.front().name)));
    if (plan.plans.size() == 1)
      require_memory(request, plan.members.size(), first.lattice.element_count);
  }
  const Plugin& plugin = *plan.plans.front().plugin;
  if (plugin.ensemble_lanes != nullptr)
    plan.lanes = plugin.ensemble_lanes(plan.plans.front().precision);
  plan.batches = group_members(plan.plans, plan.lanes);
  return plan;
}

} // namespace dss
