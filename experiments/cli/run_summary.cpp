#include "experiments/cli/run_summary.hpp"
#include "experiments/base/text_table.hpp"
#include "solver/cores.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

void print_device(const RunResult& result) {
  const DeviceUse& use = result.device_use;
  const double steps = double(result.advanced_steps());
  if (!use.device.id.empty())
    fmt::print("device {} ({}): built in {:.3g} s{}, a step {:.4g} launches of {:.3g} us, {:.4g} "
               "bytes to and {:.4g} "
               "from it in {:.3g} us\n",
               use.device.id, use.device.name, use.build_s, use.is_cached ? " from the cache" : "",
               use.launches / steps, 1e6 * use.launch_s, use.to_device_bytes / steps,
               use.from_device_bytes / steps, 1e6 * use.transfer_s / steps);
  if (result.hybrid.members.empty()) return;
  std::vector<std::string> members;
  for (const HybridInfo::Entry& entry : result.hybrid.members)
    members.push_back(fmt::format("{} {:.1f} % of the elements, {:.4g} million element-steps/s",
                                  entry.member, 100 * entry.share, 1e-6 * entry.speed));
  fmt::print("hybrid: {}; re-balanced {} times{}{}\n", fmt::join(members, "; "),
             result.hybrid.rebalances, result.hybrid.reason.empty() ? "" : "; ",
             result.hybrid.reason);
}

void print_model(const RunResult& result) {
  const ModelChoice& choice = result.model_choice;
  if (choice.asked != "auto") return;
  fmt::print("model {}: {}\n", name(choice.chosen), choice.why);
  const ModelReport& report = result.model_report;
  if (choice.is_bounded)
    fmt::print("largest rotation within the bound {:.3g} rad, error of the model at most {:.3g}, "
               "{} looks\n",
               report.largest_rotation, report.estimate, report.looks);
  for (const Promotion& promotion : report.promotions)
    fmt::print("promoted from {} to {}: after step {} the error may be {:.3g}; on from step {}\n",
               name(promotion.from), name(promotion.to), promotion.step, promotion.estimate,
               promotion.resumed_step);
}

void print_balance(const RunResult& result) {
  if (result.balance && result.balance->is_resolved) {
    const EnergyShares& shares = *result.balance;
    fmt::print("energy balance: {:.4g} J at the start, {:+.4g} J by loads, {}; {}\n", shares.start,
               shares.work,
               shares.is_complete ? fmt::format("{:.4g} J to dampers", shares.dissipated)
                                  : "an unknown part to dampers",
               shares.is_complete ? fmt::format("error {:.2g} of the energy", shares.error)
                                  : fmt::format("gained at most {:.2g} of the energy",
                                                std::max(0.0, shares.error)));
  }
  if (const auto& limit = result.stability_limit_end_s; limit && result.dt_s > *limit)
    fmt::print("the step is above the stability limit of the final state, {:.6g} s; a longer run "
               "may grow\n",
               *limit);
}

void print_guard(const RunResult& result) {
  if (!result.guard) return;
  const GuardReport& guard = *result.guard;
  fmt::print(
      "guard: {} of {} steps computed again by {} ({} comparison{}): the same bits; {:.2g} % "
      "of the time\n",
      guard.checked_steps, result.advanced_steps(), guard.witness, guard.checks,
      guard.checks == 1 ? "" : "s", 100 * guard.time_s / (guard.time_s + result.wall_s));
}

/// " (fastest of 8 samples, mean of 5 runs)"; empty for one run.
std::string samples_text(const RunResult& result) {
  std::vector<std::string> parts;
  if (result.samples > 1) parts.push_back(fmt::format("fastest of {} samples", result.samples));
  if (result.runs > 1) parts.push_back(fmt::format("mean of {} runs", result.runs));
  return parts.empty() ? "" : fmt::format(" ({})", fmt::join(parts, ", "));
}

} // namespace

std::string reactions_text(const Reactions& reactions) {
  return fmt::format("clamps exert a force of ({:.6g}) N, and a moment of ({:.6g}) N m about the "
                     "frame's origin",
                     fmt::join(reactions.force, ", "), fmt::join(reactions.moment, ", "));
}

void print_summary(const RunResult& result) {
  fmt::print("{}: {} elements, {} links, {} steps of {}{:g} s ({}, {}, {})\n", result.scene,
             result.elements, result.links, result.steps, result.adaptive ? "first " : "",
             result.dt_s, result.model, result.precision, result.integrator);
  print_model(result);
  fmt::print("{} ({}), {} thread{}{}, {}\n", result.variant, result.isa, result.threads,
             result.threads == 1 ? "" : "s",
             result.workers < result.threads ? fmt::format(" ({} with work)", result.workers) : "",
             result.schedule);
  if (const int cores = usable_cores(), busy = std::min(result.threads, result.workers);
      busy > cores)
    fmt::print("{} threads share {} core{}: a time that says nothing of speed\n", busy, cores,
               cores == 1 ? "" : "s");
  fmt::print("wall {:.6g} s{}, {:.4g} million element-steps/s, {:.1f} bytes an element\n",
             result.wall_s, samples_text(result), 1e-6 * result.element_steps_per_s(),
             double(result.bytes) / double(result.elements));
  if (result.adaptive)
    fmt::print("adaptive, rtol {:g}, atol {:g}: {} steps of {:.3g} to {:.3g} s accepted, {} "
               "rejected, to t = {:g} s\n",
               result.adaptive->rtol, result.adaptive->atol, result.steps, result.least_step_s,
               result.largest_step_s, result.rejected_steps, result.end_s);
  fmt::print("time to the first step {:.3g} s\n", result.first_step_s);
  if (result.factors.count > 0)
    fmt::print("{} factorisation{} in {:.3g} s, {:.3g} MB\n", result.factors.count,
               result.factors.count == 1 ? "" : "s", result.factors.time_s,
               1e-6 * result.factors.bytes);
  print_device(result);
  fmt::print("largest displacement {:.6g} m, energy {}, state {:016x}\n", result.max_displacement_m,
             result.energy_j ? fmt::format("{:.6g} J", *result.energy_j)
                             : "not computed (large state)",
             result.digest);
  if (result.reactions) fmt::print("{}\n", reactions_text(*result.reactions));
  if (result.check.is_done)
    fmt::print("check: {} ({}): error {:.3g}, tolerance {:.3g}\n",
               result.check.is_passed() ? "passed" : "failed", result.check.how, result.check.error,
               result.check.tolerance);
  if (result.reference)
    fmt::print("displacements against the solution at {} times: error {:.3g} at the end, {:.3g} "
               "rms, {:.3g} at most (the "
               "solution's own: {:.1g})\n",
               result.reference->times.count, result.reference->accuracy.final,
               result.reference->accuracy.l2, result.reference->accuracy.max,
               result.reference->error);
  print_guard(result);
  print_balance(result);
  if (result.energy_drift) fmt::print("energy drift {:.3g}\n", *result.energy_drift);
  if (result.ranks.ranks > 1)
    fmt::print("{:.4g} messages and {:.4g} bytes a step, {:.1f} % of the time in exchanges, "
               "imbalance {:.3f}\n",
               result.messages_per_step, result.bytes_per_step, 100 * result.communication_share,
               result.ranks.imbalance);
  if (!result.ranks.halo_reason.empty())
    fmt::print("halo {}: {}\n", result.ranks.halo, result.ranks.halo_reason);
  for (const std::string& probe : result.probes) fmt::print("{}\n", probe);
  for (const std::string& file : result.files) fmt::print("wrote {}\n", file);
}

void print_ensemble(const EnsembleResult& result) {
  const RunResult& whole = result.whole;
  fmt::print("{}: {} members, {} elements, {} links, {} steps ({}, {})\n", whole.scene,
             result.members.size(), whole.elements, whole.links, whole.steps, whole.precision,
             whole.integrator);
  fmt::print("{} ({}), {} thread{}{}, {}\n", whole.variant, whole.isa, whole.threads,
             whole.threads == 1 ? "" : "s",
             whole.workers < whole.threads ? fmt::format(" ({} with work)", whole.workers) : "",
             whole.schedule);
  fmt::print("wall {:.6g} s{}, {:.4g} million element-steps/s\n", whole.wall_s, samples_text(whole),
             1e-6 * whole.element_steps_per_s());
  std::vector<std::vector<std::string>> rows;
  for (const auto& [member, own] : result.members)
    rows.push_back({member.name, own.status, own.model, fmt::format("{}", own.steps),
                    fmt::format("{:g}", own.dt_s), fmt::format("{:.6g}", own.max_displacement_m),
                    own.energy_j ? fmt::format("{:.6g}", *own.energy_j) : "",
                    fmt::format("{:016x}", own.digest)});
  fmt::print("{}", text_table({"member", "status", "model", "steps", "step [s]", "displacement [m]",
                               "energy [J]", "state"},
                              rows));
  for (const std::string& file : whole.files) fmt::print("wrote {}\n", file);
}

} // namespace dss
