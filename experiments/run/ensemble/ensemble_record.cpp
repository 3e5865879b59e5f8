#include "experiments/run/ensemble/ensemble_record.hpp"

#include "experiments/run/timed/run_record.hpp"

#include <algorithm>
#include <limits>

namespace dss {

/// Of several members the largest errors count.
static void add_check(const CheckResult& own, CheckResult& all) {
  if (!own.is_done) return;
  const CheckResult before = all;
  all = own;
  if (!before.is_done) return;
  all.error = std::max(all.error, before.error);
  if (all.tail_error && before.tail_error)
    all.tail_error = std::max(*all.tail_error, *before.tail_error);
}

/// Leaves out what is not the same for all members.
static void keep_common(const RunResult& own, RunResult& all) {
  const auto keep = [](double of_one, double& of_all) {
    if (of_one != of_all) of_all = std::numeric_limits<double>::quiet_NaN();
  };
  keep(own.dt_s, all.dt_s);
  keep(own.end_s, all.end_s);
  keep(own.stability_limit_s, all.stability_limit_s);
  if (own.evaluations != all.evaluations) all.evaluations.reset();
  if (own.model != all.model) all.model = "several";
}

void add_member(const RunResult& member, RunResult& whole) {
  *whole.element_steps += double(member.elements) * double(member.steps - member.resumed_step);
  whole.max_displacement_m = std::max(whole.max_displacement_m, member.max_displacement_m);
  whole.files.insert(whole.files.end(), member.files.begin(), member.files.end());
  add_check(member.check, whole.check);
  keep_common(member, whole);
}

nlohmann::ordered_json ensemble_json(const RunRequest& request, const EnsembleResult& result) {
  nlohmann::ordered_json json = run_json(request, result.whole);
  nlohmann::ordered_json members = nlohmann::ordered_json::array();
  for (const MemberResult& member : result.members) {
    nlohmann::ordered_json own = {{"name", member.member.name},
                                  {"set", nlohmann::ordered_json::object()}};
    for (const Override& item : member.member.set) own["set"][item.key] = item.value;
    own.update(run_json(member.result));
    members.push_back(std::move(own));
  }
  json["ensemble"] = {
      {"batches", result.batches}, {"lanes", result.lanes}, {"members", std::move(members)}};
  return json;
}

} // namespace dss
