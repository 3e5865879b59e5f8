#include "experiments/run/guard/guard.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/api/kept_state.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr std::size_t piece = 4096; ///< elements that are compared at once
constexpr const char* advice = "a processor or memory may be faulty: run it elsewhere, or from a "
                               "checkpoint of before";

/// What a kept number is (variants/api/kept_state.hpp).
std::string name_of_number(int number, const Method& method) {
  constexpr std::array<const char*, field_count> fields = {"ux", "uy", "uz", "vx", "vy", "vz", "qs",
                                                           "qx", "qy", "qz", "wx", "wy", "wz"};
  if (number < int(field_count)) return fields[std::size_t(number)];
  const int low = kept_first_low(method);
  if (number >= low) return fmt::format("low part of {}", fields[std::size_t(number - low)]);
  if (number == kept_is_started) return "mark of the start";
  const int velocity = number - kept_half_velocities;
  return fmt::format("half-step {}",
                     fields[std::size_t(velocity < 3 ? vx + velocity : wx + velocity - 3)]);
}

/// The fastest other variant of this machine that rounds alike and computes by itself; else the
/// variant itself, which finds what does not happen twice.
std::string chosen_witness(const RunPlan& plan, const std::string& variant, bool has_fma) {
  std::string chosen = variant;
  for (const VariantStatus& status : variants()) {
    if (!status.is_usable() || status.is_by_name || status.name == variant) continue;
    const Plugin& plugin = load_variant(status.name);
    if (plugin.has_fma == has_fma && !plugin.has_all &&
        !what_lacks(plugin, plan.precision, *plan.method, plan.rotation))
      chosen = status.name;
  }
  return chosen;
}

} // namespace

void require_sound_guard(const RunRequest& request, const RunPlan& plan) {
  const auto refuse = [](const std::string& what) { throw InputError(what); };
  if (request.guard < 0) refuse(fmt::format("--guard {}: give 1 step or more", request.guard));
  if (request.guard == 0) {
    if (request.guard_steps != 1 || request.guard_variant != "auto")
      refuse("--guard-steps, --guard-variant: give --guard N, too");
    return;
  }
  if (request.guard_steps < 1 || request.guard_steps > request.guard)
    refuse(fmt::format("--guard-steps {}: give 1 to {}, the steps of --guard", request.guard_steps,
                       request.guard));
  if (plan.adaptive) refuse("--guard: steps must be equal; leave --rtol out");
  if (request.samples > 1 || request.repeat_for > 0)
    refuse("--guard: a run that is repeated for its time has none; leave --samples and "
           "--repeat-for out");
  if (plan.plugin->has_all)
    refuse(fmt::format("--guard: variant {} does not give out what its methods keep; give another "
                       "--variant",
                       plan.plugin->name));
}

Guard::Guard(const RunRequest& request, const RunPlan& plan, Executor& run,
             const std::string& variant, bool has_fma)
    : request_(request), plan_(plan), width_(std::size_t(kept_fields(run))) {
  if (width_ == 0)
    throw InputError(fmt::format("--guard: variant {} does not give out what its methods keep; "
                                 "give another --variant",
                                 variant));
  const std::string witness = request.guard_variant == "auto"
                                  ? chosen_witness(plan, variant, has_fma)
                                  : request.guard_variant;
  const Plugin& plugin = load_variant(witness);
  if (plugin.has_fma != has_fma || plugin.has_all || plugin.is_distributed)
    throw InputError(fmt::format("--guard-variant {}: it does not round as {}, or gives its state "
                                 "to nobody; leave the option out",
                                 witness, variant));
  distribution_ = plan.distribution;
  distribution_.variant = witness;
  if (plan.plugin->is_distributed) distribution_.halo = rank_info(run).halo; // without a trial
  plugin_ = plan.plugin->is_distributed ? plan.plugin : &plugin;
  report_ = {witness, request.guard, request.guard_steps};
}

std::unique_ptr<Executor> Guard::created(Model model) const {
  return plugin_->create({plan_.scene.problem, *plan_.method, model, plan_.precision, plan_.dt,
                          request_.threads, nullptr, &distribution_, "", "", plan_.rotation});
}

std::string Guard::look(Executor& run, Model model, long step) {
  const bool is_last = step == plan_.steps, is_end = step == end_ || (end_ != none && is_last);
  const bool is_begin = (step % report_.every == 0 || is_first_) && !is_last;
  if (!is_end && !is_begin) return "";
  const auto start = Clock::now();
  const std::string difference = is_end ? compare(run, step) : "";
  if (is_begin && difference.empty()) begin(run, model, step, is_end);
  report_.time_s += seconds_since(start);
  return difference;
}

void Guard::begin(Executor& run, Model model, long step, bool has_state) {
  if (!witness_ || model != model_) {
    witness_.reset();
    witness_ = created(model);
    model_ = model;
    has_state = false;
  }
  if (!has_state) copy(run);
  is_first_ = false;
  begin_ = step;
  end_ = std::min(step + report_.steps, next_multiple(step));
}

std::string Guard::go_back(long step, std::span<const double> state) {
  if (end_ == none || step <= begin_) {
    forget();
    return "";
  }
  const auto start = Clock::now();
  std::string difference = advance_witness(step);
  std::vector<double> of_witness(state.size());
  witness_->read(0, of_witness);
  if (difference.empty()) difference = difference_of(state, of_witness, field_count, 0, step);
  forget();
  report_.time_s += seconds_since(start);
  return difference;
}

long Guard::steps_left(long step, long most) const {
  return std::min(most, (end_ != none ? end_ : next_multiple(step)) - step);
}

void Guard::copy(Executor& run) {
  const std::size_t elements = plan_.scene.problem.lattice.element_count;
  for (std::size_t first = 0; first < elements; first += piece) {
    of_run_.resize(std::min(piece, elements - first) * width_);
    save(run, first, of_run_);
    restore(*witness_, first, of_run_);
  }
}

std::string Guard::advance_witness(long step) {
  const Problem& problem = plan_.scene.problem;
  const long steps = step - begin_;
  const Outcome outcome =
      witness_->advance(steps, signal_rows(problem, *plan_.method, plan_.dt, begin_, steps));
  ++report_.checks;
  report_.checked_steps += steps;
  if (outcome.is_finite) return "";
  return fmt::format("between steps {} and {}, element {} is not finite by {} alone; {}", begin_,
                     step, outcome.element, report_.witness, advice);
}

std::string Guard::difference_of(std::span<const double> of_run, std::span<const double> of_witness,
                                 std::size_t width, std::size_t first, long step) const {
  const auto bits = [&](double number) { return common_bits(number, plan_.precision); };
  for (std::size_t n = 0; n < of_run.size(); ++n)
    if (bits(of_run[n]) != bits(of_witness[n]))
      return fmt::format("between steps {} and {}, {} of element {} became {} and by {} {}; {}",
                         begin_, step, name_of_number(int(n % width), *plan_.method),
                         first + n / width, of_run[n], report_.witness, of_witness[n], advice);
  return "";
}

std::string Guard::compare(Executor& run, long step) {
  std::string difference = advance_witness(step);
  end_ = none;
  const std::size_t elements = plan_.scene.problem.lattice.element_count;
  for (std::size_t first = 0; first < elements; first += piece) {
    of_run_.resize(std::min(piece, elements - first) * width_);
    of_witness_.resize(of_run_.size());
    save(run, first, of_run_); // collective, so for all pieces
    save(*witness_, first, of_witness_);
    if (difference.empty()) difference = difference_of(of_run_, of_witness_, width_, first, step);
  }
  return difference;
}

} // namespace dss
