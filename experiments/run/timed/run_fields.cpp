#include "experiments/run/timed/run_fields.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

using Json = nlohmann::ordered_json;
using R = const RunResult&;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
template <class T>
Json if_adaptive(R r, const T& value) {
  return r.adaptive ? Json(value) : Json();
}
template <class T>
Json on_device(R r, const T& value) {
  return r.device_use.device.id.empty() ? Json() : Json(value);
}
Json per_step(R r, double value) { return on_device(r, value / double(r.advanced_steps())); }
template <class T>
Json of_hybrid(R r, const T& value) {
  return r.hybrid.members.empty() ? Json() : Json(value);
}
template <class T>
Json by_factors(R r, const T& value) {
  return r.factors.count == 0 ? Json() : Json(value);
}
template <class T>
Json of_state(R r, const T& value) {
  const bool has_end = r.status == "ok" || r.status == "wrong";
  return has_end ? Json(value) : Json();
}
template <class T>
Json if_checked(R r, const T& value) {
  return r.check.is_done ? Json(value) : Json();
}
/// A number of the comparison with the solution.
Json of_reference(R r, double Accuracy::*number) {
  return r.reference ? Json(r.reference->accuracy.*number) : Json();
}
template <class T>
Json of_times(R r, T SavedTimes::*member) {
  return r.reference ? Json(r.reference->times.*member) : Json();
}

/// "smaller" has the reasons against each model of less work. "monitor" is null if nothing was
/// watched.
Json model_choice(R r) {
  const ModelChoice& choice = r.model_choice;
  const ModelReport& report = r.model_report;
  Json smaller = Json::object(), promotions = Json::array(), monitor;
  for (const auto& [model, reason] : choice.smaller) smaller[std::string(name(model))] = reason;
  for (const Promotion& promotion : report.promotions)
    promotions.push_back({{"step", promotion.step},
                          {"resumed_step", promotion.resumed_step},
                          {"from", name(promotion.from)},
                          {"to", name(promotion.to)},
                          {"estimate", promotion.estimate}});
  if (choice.is_bounded)
    monitor = {{"largest_rotation_rad", report.largest_rotation},
               {"estimate", report.estimate},
               {"limit", bounded_share * choice.tolerance},
               {"looks", report.looks},
               {"look_s", report.look_s}};
  return {
      {"asked", choice.asked}, {"chosen", name(choice.chosen)},   {"why", choice.why},
      {"smaller", smaller},    {"is_bounded", choice.is_bounded}, {"tolerance", choice.tolerance},
      {"monitor", monitor},    {"promotions", promotions}};
}

Json guard(R r) {
  if (!r.guard) return {};
  return {{"witness", r.guard->witness},
          {"every", r.guard->every},
          {"steps", r.guard->steps},
          {"checks", r.guard->checks},
          {"checked_steps", r.guard->checked_steps},
          {"time_s", r.guard->time_s}};
}

Json network(R r) {
  const Network& network = r.ranks.network;
  return {{"latency_s", network.latency_s},
          {"seconds_a_byte", network.seconds_a_byte},
          {"overhead_s", network.overhead_s},
          {"overhead_s_a_byte", network.overhead_s_a_byte}};
}

Json device(R r) {
  const DeviceEntry& device = r.device_use.device;
  return on_device(r, Json{{"id", device.id},
                           {"kind", device.kind},
                           {"name", device.name},
                           {"platform", device.platform},
                           {"version", device.version},
                           {"compute_units", device.compute_units}});
}

Json hybrid(R r) {
  Json members = Json::array();
  for (const HybridInfo::Entry& entry : r.hybrid.members)
    members.push_back({{"member", entry.member},
                       {"element_steps_per_s", entry.speed},
                       {"share", entry.share},
                       {"step_s", entry.step_s}});
  return of_hybrid(
      r,
      Json{{"members", members}, {"rebalances", r.hybrid.rebalances}, {"reason", r.hybrid.reason}});
}

/// Members with their shares: "avx512:1 0.550; opencl@cpu:1 0.450".
Json members_with_shares(R r) {
  std::string text;
  for (const HybridInfo::Entry& entry : r.hybrid.members)
    text += fmt::format("{}{} {:.3f}", text.empty() ? "" : "; ", entry.member, entry.share);
  return of_hybrid(r, text);
}

/// Not judged on a GPU: the time of a GPU is not CPU time.
bool is_run_contaminated(R r) {
  const std::string& kind = r.device_use.device.kind;
  const bool is_elsewhere = !kind.empty() && kind != "cpu";
  return !is_elsewhere && is_contaminated(r.usage, r.sample_s(), r.workers, !kind.empty());
}

Json of_balance(R r, double EnergyShares::*share) {
  return r.balance ? Json((*r.balance).*share) : Json();
}

std::string verdict(const CheckResult& check) {
  return !check.is_done ? "none" : check.is_passed() ? "passed" : "failed";
}

constexpr Aggregate last = Aggregate::last, median = Aggregate::median,
                    distinct = Aggregate::distinct, largest = Aggregate::largest;
const RunField fields[] = {
    {"variant", "", "", "variant that ran, with that of its parts: mpi:avx512",
     [](R r) { return Json(r.variant); }},
    {"isa", "isa", "", "instruction set of the code that ran, as that code says",
     [](R r) { return Json(r.isa); }, last},
    {"has_fma", "has_fma", "", "its bits are those of every other variant with fused multiply-add",
     [](R r) { return Json(r.has_fma); }},
    {"model", "", "", "model at the end of the run", [](R r) { return Json(r.model); }},
    {"model_choice", "", "", "what --model auto chose, and why",
     [](R r) { return model_choice(r); }},
    {"precision", "", "", "f64, f32 or f32c", [](R r) { return Json(r.precision); }},
    {"integrator", "", "", "method", [](R r) { return Json(r.integrator); }},
    {"rotation", "", "", "description of rotations", [](R r) { return Json(r.rotation); }},
    {"threads", "", "", "threads of each rank, as asked for", [](R r) { return Json(r.threads); }},
    {"workers", "workers", "",
     "threads that compute, on all ranks: fewer than asked for where a part has too few rows",
     [](R r) { return Json(r.workers); }, last},
    {"ranks", "", "", "processes", [](R r) { return Json(r.ranks.ranks); }},
    {"decomposition", "", "", "method of decomposition",
     [](R r) { return Json(r.ranks.decomposition); }},
    {"halo", "halo_used", "",
     "halo strategy that ran; \"deep or shared\": auto chose one in some repetitions, the other in "
     "others",
     [](R r) { return Json(r.ranks.halo); }, distinct},
    {"halo_reason", "halo_reason", "", "why auto chose this strategy",
     [](R r) { return Json(r.ranks.halo_reason); }},
    {"network", "", "", "latency and cost of a byte that the ranks measured",
     [](R r) { return network(r); }},
    {"imbalance", "imbalance", "", "own elements of the largest part over the mean",
     [](R r) { return Json(r.ranks.imbalance); }, last},
    {"messages_per_step", "messages_per_step", "", "messages that all ranks send in a step",
     [](R r) { return Json(r.messages_per_step); }, last},
    {"bytes_per_step", "bytes_per_step", "B", "bytes that all ranks send in a step",
     [](R r) { return Json(r.bytes_per_step); }, last},
    {"communication_share", "communication_share", "",
     "time in exchanges over the wall time, mean over ranks; waiting for a slower neighbour counts",
     [](R r) { return Json(r.communication_share); }, median},
    {"elements", "elements", "", "elements of the scene", [](R r) { return Json(r.elements); },
     last},
    {"links", "links", "", "links of the scene", [](R r) { return Json(r.links); }, last},
    {"steps", "", "", "steps of the run; with adaptive steps, those that were accepted",
     [](R r) { return Json(r.steps); }},
    {"resumed_step", "", "",
     "step that --restart continued from; times and rates are of the steps after it",
     [](R r) { return Json(r.resumed_step); }},
    {"warmup_steps", "", "", "steps before the clock starts",
     [](R r) { return Json(r.warmup_steps); }},
    {"dt_s", "dt_s", "s", "step; of adaptive steps the first that is tried",
     [](R r) { return Json(r.dt_s); }},
    {"end_s", "", "s", "end of the run", [](R r) { return Json(r.end_s); }},
    {"rtol", "", "", "relative tolerance of adaptive steps",
     [](R r) { return if_adaptive(r, r.adaptive ? r.adaptive->rtol : 0); }},
    {"atol", "", "", "absolute tolerance of adaptive steps",
     [](R r) { return if_adaptive(r, r.adaptive ? r.adaptive->atol : 0); }},
    {"accepted_steps", "accepted_steps", "", "adaptive steps that were accepted",
     [](R r) { return if_adaptive(r, r.steps); }},
    {"rejected_steps", "rejected_steps", "", "adaptive steps that were rejected",
     [](R r) { return if_adaptive(r, r.rejected_steps); }},
    {"least_step_s", "", "s", "smallest accepted step",
     [](R r) { return if_adaptive(r, r.least_step_s); }},
    {"largest_step_s", "", "s", "largest accepted step",
     [](R r) { return if_adaptive(r, r.largest_step_s); }},
    {"evaluations", "evaluations", "", "force evaluations of each element",
     [](R r) { return or_null(r.evaluations); }},
    {"stability_limit_s", "", "s", "predicted largest stable step",
     [](R r) { return Json(r.stability_limit_s); }},
    {"stability_limit_end_s", "", "s",
     "the same in the final state, estimated; of scenes of at most 2000 elements",
     [](R r) { return or_null(r.stability_limit_end_s); }},
    {"wall_s", "wall_s", "s", "time inside the executor's advance(), a run",
     [](R r) { return Json(r.wall_s); }},
    {"stages", "stages", "", "force evaluations a step", [](R r) { return Json(r.stages); }},
    {"samples", "samples", "",
     "samples that one repetition took; wall_s, runs, sample_s, element_steps_per_s and cpu_s to "
     "contaminated are of the fastest, all others of the first run",
     [](R r) { return Json(r.samples); }},
    {"runs", "runs", "", "runs of the sample; wall_s is their mean",
     [](R r) { return Json(r.runs); }},
    {"sample_s", "sample_s", "s", "time of all runs of the sample together",
     [](R r) { return Json(r.sample_s()); }},
    {"first_step_s", "first_step_s", "s", "making the executor, and the very first step",
     [](R r) { return Json(r.first_step_s); }, median},
    {"factorisations", "factorisations", "",
     "factorisations of a matrix, from making the executor to the end of the first run",
     [](R r) { return by_factors(r, r.factors.count); }, last},
    {"factor_s", "factor_s", "s",
     "time of these factorisations: linear models have theirs in first_step_s, others in wall_s",
     [](R r) { return by_factors(r, r.factors.time_s); }, median},
    {"factor_bytes", "factor_bytes", "B", "memory while the last factorisation ran",
     [](R r) { return by_factors(r, r.factors.bytes); }, last},
    {"cpu_s", "cpu_s", "s",
     "CPU time of all threads while the steps advance: wall_s, and making the loads' values",
     [](R r) { return Json(r.usage.cpu_s / double(r.runs)); }},
    {"wait_s", "wait_s", "s",
     "time that threads were runnable and had no core; empty where the kernel does not tell",
     [](R r) { return Json(r.usage.wait_s / double(r.runs)); }},
    {"steal_s", "steal_s", "s",
     "time that the hypervisor took from busy processors of the machine, in ticks of 10 ms",
     [](R r) { return Json(r.usage.steal_s / double(r.runs)); }},
    {"others_s", "others_s", "s",
     "time that everything else on the machine ran, to some 0.01 s; ranks on several machines "
     "count "
     "one another; empty where it is not known",
     [](R r) { return Json(r.usage.others_s / double(r.runs)); }},
    {"involuntary_switches", "involuntary_switches", "", "times that the kernel took a core away",
     [](R r) { return Json(r.usage.involuntary_switches); }},
    {"is_contaminated", "contaminated", "",
     "wait_s + steal_s is above 1 % of wall_s x workers, or the cpu_s of a single worker below "
     "0.97 wall_s; of devices with threads on the same processors at most others_s - 0.01 s counts "
     "as wait; not judged where a GPU computes",
     [](R r) { return Json(is_run_contaminated(r)); }},
    {"element_steps_per_s", "element_steps_per_s", "1/s", "elements x steps over wall_s",
     [](R r) { return Json(r.element_steps_per_s()); }},
    {"energy_j", "energy_j", "J",
     "kinetic and elastic energy of the final state; loads and gravity do not count",
     [](R r) { return or_null(r.energy_j); }},
    {"reaction_force_n", "", "N", "force of all clamps on the bodies, in the final state",
     [](R r) { return r.reactions ? Json(r.reactions->force) : Json(); }},
    {"reaction_moment_n_m", "", "N m", "their moment about the frame's origin",
     [](R r) { return r.reactions ? Json(r.reactions->moment) : Json(); }},
    {"energy_drift", "energy_drift", "",
     "relative change of energy over the run, where nothing damps or loads",
     [](R r) { return or_null(r.energy_drift); }},
    {"energy_start_j", "", "J", "the same energy of the state from which its balance is followed",
     [](R r) { return of_balance(r, &EnergyShares::start); }},
    {"work_j", "", "J", "work of loads and of the frame's acceleration",
     [](R r) { return of_balance(r, &EnergyShares::work); }},
    {"dissipated_j", "", "J",
     "what dampers took; empty where it was not followed: runs of more than 1.2e6 element-steps",
     [](R r) {
       return r.balance && r.balance->is_complete ? Json(r.balance->dissipated) : Json();
     }},
    {"energy_error", "", "",
     "energy without a source, over the energy at the end, which counts as at least 0.1 times the "
     "largest of the run; what dampers have taken of it since does not count; without dissipated_j "
     "what the run gained at most, and judged on that side alone; above 0.1 the run is wrong",
     [](R r) { return r.balance && r.balance->is_resolved ? Json(r.balance->error) : Json(); }},
    {"max_displacement_m", "max_displacement_m", "m",
     "largest displacement of an element at the end",
     [](R r) { return of_state(r, r.max_displacement_m); }},
    {"state_digest", "state_digest", "",
     "64 bits of the final state: equal for all variants with FMA and any number of threads and "
     "ranks",
     [](R r) { return of_state(r, fmt::format("{:016x}", r.digest)); }, last},
    {"schedule", "schedule", "", "how the executor orders rows and stages",
     [](R r) { return Json(r.schedule); }, last},
    {"bytes", "bytes", "B", "memory for state, halos, rings and masks",
     [](R r) { return Json(r.bytes); }},
    {"device", "", "", "device that computed", [](R r) { return device(r); }},
    {"device_used", "device_used", "", "platform:device and name of the device that computed",
     [](R r) {
       return on_device(r, fmt::format("{} {}", r.device_use.device.id, r.device_use.device.name));
     },
     last},
    {"build_s", "build_s", "s",
     "making the device program ready: compilation, or reading it from the cache; of a cell the "
     "longest",
     [](R r) { return on_device(r, r.device_use.build_s); }, largest},
    {"build_is_cached", "", "", "no device program was compiled",
     [](R r) { return on_device(r, r.device_use.is_cached); }},
    {"launches", "", "", "kernels launched",
     [](R r) { return on_device(r, r.device_use.launches); }},
    {"launches_per_step", "launches_per_step", "", "kernels launched in a step",
     [](R r) { return per_step(r, r.device_use.launches); }, median},
    {"to_device_bytes", "", "B", "bytes sent to the device",
     [](R r) { return on_device(r, r.device_use.to_device_bytes); }},
    {"to_device_bytes_per_step", "to_device_bytes_per_step", "B",
     "bytes sent to the device in a step",
     [](R r) { return per_step(r, r.device_use.to_device_bytes); }, median},
    {"from_device_bytes", "", "B", "bytes read from the device",
     [](R r) { return on_device(r, r.device_use.from_device_bytes); }},
    {"from_device_bytes_per_step", "from_device_bytes_per_step", "B",
     "bytes read from the device in a step",
     [](R r) { return per_step(r, r.device_use.from_device_bytes); }, median},
    {"transfer_s", "", "s", "time in transfers by the device's clock, hidden by computation or not",
     [](R r) { return on_device(r, r.device_use.transfer_s); }},
    {"transfer_us_per_step", "transfer_us_per_step", "us", "the same, a step",
     [](R r) { return per_step(r, 1e6 * r.device_use.transfer_s); }, median},
    {"launch_s", "", "s", "one empty launch and its end",
     [](R r) { return on_device(r, r.device_use.launch_s); }},
    {"launch_us", "launch_us", "us", "the same",
     [](R r) { return on_device(r, 1e6 * r.device_use.launch_s); }, median},
    {"hybrid", "", "", "members of a hybrid", [](R r) { return hybrid(r); }},
    {"members", "members", "", "members of a hybrid and their shares of the elements at the end",
     [](R r) { return members_with_shares(r); }, last},
    {"rebalances", "rebalances", "", "times that elements moved between members",
     [](R r) { return of_hybrid(r, r.hybrid.rebalances); }, median},
    {"hybrid_reason", "hybrid_reason", "", "why the hybrid chose its members",
     [](R r) { return of_hybrid(r, r.hybrid.reason); }, last},
    {"guard", "", "", "what --guard computed once more, and its time, which wall_s leaves out",
     [](R r) { return guard(r); }},
    {"check", "check", "", "passed, failed, or none", [](R r) { return Json(verdict(r.check)); }},
    {"check_how", "check_how", "", "what the state was compared with, and when",
     [](R r) { return Json(r.check.how); }},
    {"check_tolerance", "check_tolerance", "", "largest error that passes",
     [](R r) { return if_checked(r, r.check.tolerance); }, last},
    {"check_error", "check_error", "", "error against the oracle after some steps",
     [](R r) { return if_checked(r, r.check.error); }},
    {"check_tail_error", "check_tail_error", "",
     "error over the last 2 steps of a longer run, from the run's own state",
     [](R r) { return or_null(r.check.tail_error); }},
    {"end_time_s", "end_time_s", "s", "last saved time",
     [](R r) { return of_times(r, &SavedTimes::end); }},
    {"saved_times", "saved_times", "", "times at which the run is compared with the solution",
     [](R r) { return of_times(r, &SavedTimes::count); }},
    {"error_final", "error_final", "",
     "largest difference of displacements from the solution at the last saved time, over the "
     "largest displacement at any",
     [](R r) { return of_reference(r, &Accuracy::final); }},
    {"error_l2", "error_l2", "", "the same at each saved time, root mean square",
     [](R r) { return of_reference(r, &Accuracy::l2); }},
    {"error_max", "error_max", "",
     "the same, largest over the saved times: what Pareto front and tolerances go by",
     [](R r) { return of_reference(r, &Accuracy::max); }},
    {"error_rotation", "error_rotation", "", "the same of q, over its own largest number",
     [](R r) { return of_reference(r, &Accuracy::rotation); }},
    {"error_velocity", "error_velocity", "", "the same of v",
     [](R r) { return of_reference(r, &Accuracy::velocity); }},
    {"error_spin", "error_spin", "", "the same of w",
     [](R r) { return of_reference(r, &Accuracy::spin); }},
    {"reference_error", "reference_error", "", "estimated error of the solution itself",
     [](R r) { return r.reference ? Json(r.reference->error) : Json(); }},
    {"status", "status", "", "ok, unstable, wrong, bound or faulty; with reason",
     [](R r) { return Json(r.status); }, last},
    {"reason", "reason", "", "why the status is not ok", [](R r) { return Json(r.reason); }, last},
};

} // namespace

std::span<const RunField> run_fields() { return fields; }

} // namespace dss
