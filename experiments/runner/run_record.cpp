/// The record of a run as JSON.
#include "experiments/runner/context.hpp"
#include "experiments/runner/run.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

using Json = nlohmann::ordered_json;

/// Nulls for a run that used none.
void add_device(const DeviceUse& use, Json& json) {
  const bool is_used = !use.device.id.empty();
  const auto if_used = [&](const auto& value) { return is_used ? Json(value) : Json(); };
  json["device"] = if_used(Json{{"id", use.device.id},
                                {"kind", use.device.kind},
                                {"name", use.device.name},
                                {"platform", use.device.platform},
                                {"version", use.device.version},
                                {"compute_units", use.device.compute_units}});
  json["build_s"] = if_used(use.build_s);
  json["build_is_cached"] = if_used(use.is_cached);
  json["launches"] = if_used(use.launches);
  json["to_device_bytes"] = if_used(use.to_device_bytes);
  json["from_device_bytes"] = if_used(use.from_device_bytes);
  json["transfer_s"] = if_used(use.transfer_s);
  json["launch_s"] = if_used(use.launch_s);
}

Json hybrid_json(const HybridInfo& hybrid) {
  if (hybrid.members.empty()) return nullptr;
  Json members = Json::array();
  for (const HybridInfo::Entry& entry : hybrid.members)
    members.push_back({{"member", entry.member},
                       {"element_steps_per_s", entry.speed},
                       {"share", entry.share},
                       {"step_s", entry.step_s}});
  return {{"members", members}, {"rebalances", hybrid.rebalances}, {"reason", hybrid.reason}};
}

/// "smaller": why not each model of less work. "monitor" is null where nothing had to be watched.
Json model_choice_json(const ModelChoice& choice, const ModelReport& report) {
  Json smaller = Json::object(), promotions = Json::array();
  for (const auto& [model, reason] : choice.smaller) smaller[std::string(name(model))] = reason;
  for (const Promotion& promotion : report.promotions)
    promotions.push_back({{"step", promotion.step},
                          {"resumed_step", promotion.resumed_step},
                          {"from", name(promotion.from)},
                          {"to", name(promotion.to)},
                          {"estimate", promotion.estimate}});
  Json monitor;
  if (choice.is_bounded)
    monitor = {{"largest_rotation_rad", report.largest_rotation},
               {"estimate", report.estimate},
               {"limit", bounded_share * choice.tolerance},
               {"looks", report.looks},
               {"look_s", report.look_s}};
  return {{"asked", choice.asked}, {"chosen", name(choice.chosen)},   {"why", choice.why},
          {"smaller", smaller},    {"is_bounded", choice.is_bounded}, {"tolerance", choice.tolerance},
          {"monitor", monitor},    {"promotions", promotions}};
}

/// Nothing for a run that was measured against no solution.
void add_reference(const std::optional<ReferenceResult>& reference, Json& json) {
  if (!reference) return;
  json["end_time_s"] = reference->times.end;
  json["saved_times"] = reference->times.count;
  json["error_final"] = reference->accuracy.final;
  json["error_l2"] = reference->accuracy.l2;
  json["error_max"] = reference->accuracy.max;
  json["error_rotation"] = reference->accuracy.rotation;
  json["error_velocity"] = reference->accuracy.velocity;
  json["error_spin"] = reference->accuracy.spin;
  json["reference_error"] = reference->error;
}

} // namespace

nlohmann::ordered_json record_of(const std::string& scene, const std::vector<Override>& overrides) {
  Json json;
  json["context"] = measurement_context();
  json["scene"] = scene;
  json["set"] = Json::object();
  for (const Override& item : overrides) json["set"][item.key] = item.value;
  return json;
}

nlohmann::ordered_json run_json(const RunRequest& request, const RunResult& result) {
  Json json = record_of(result.scene, request.overrides);
  json["variant"] = result.variant;
  json["isa"] = result.isa;
  json["has_fma"] = result.has_fma;
  json["model"] = result.model;
  json["model_choice"] = model_choice_json(result.model_choice, result.model_report);
  json["precision"] = result.precision;
  json["integrator"] = result.integrator;
  json["rotation"] = result.rotation;
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
  json["end_s"] = result.end_s;
  const auto if_adaptive = [&](const auto& value) { return result.adaptive ? Json(value) : Json(); };
  const StepTolerance tolerance = result.adaptive.value_or(StepTolerance{});
  json["rtol"] = if_adaptive(tolerance.rtol);
  json["atol"] = if_adaptive(tolerance.atol);
  json["rejected_steps"] = if_adaptive(result.rejected_steps);
  json["least_step_s"] = if_adaptive(result.least_step_s);
  json["largest_step_s"] = if_adaptive(result.largest_step_s);
  json["evaluations"] = result.evaluations ? Json(*result.evaluations) : nullptr;
  json["stability_limit_s"] = result.stability_limit_s;
  json["wall_s"] = result.wall_s;
  json["stages"] = result.stages;
  json["runs"] = result.runs;
  json["sample_s"] = result.sample_s();
  json["first_step_s"] = result.first_step_s;
  json["cpu_s"] = result.usage.cpu_s / double(result.runs);
  json["wait_s"] = result.usage.wait_s / double(result.runs);
  json["involuntary_switches"] = result.usage.involuntary_switches;
  const std::string& device_kind = result.device_use.device.kind;
  const bool is_elsewhere = !device_kind.empty() && device_kind != "cpu"; // its time is no CPU time
  json["is_contaminated"] = !is_elsewhere && is_contaminated(result.usage, result.sample_s(), result.workers);
  json["element_steps_per_s"] = result.element_steps_per_s();
  json["energy_j"] = result.energy_j ? Json(*result.energy_j) : nullptr;
  json["energy_drift"] = result.energy_drift ? Json(*result.energy_drift) : nullptr;
  const bool has_state = result.status != "unstable" && result.status != "bound";
  json["max_displacement_m"] = has_state ? Json(result.max_displacement_m) : nullptr;
  json["state_digest"] = has_state ? Json(fmt::format("{:016x}", result.digest)) : nullptr;
  json["schedule"] = result.schedule;
  json["bytes"] = result.bytes;
  add_device(result.device_use, json);
  json["hybrid"] = hybrid_json(result.hybrid);
  json["check"] = result.check.is_done ? (result.check.is_passed() ? "passed" : "failed") : "none";
  json["check_how"] = result.check.how;
  json["check_tolerance"] = result.check.is_done ? Json(result.check.tolerance) : nullptr;
  json["check_error"] = result.check.is_done ? Json(result.check.error) : nullptr;
  json["check_tail_error"] = result.check.tail_error ? Json(*result.check.tail_error) : nullptr;
  add_reference(result.reference, json);
  json["status"] = result.status;
  json["reason"] = result.reason;
  return json;
}

} // namespace dss
