#include "experiments/run/guard/guard.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/api/kept_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace dss {
namespace {

constexpr std::size_t piece = 4096; ///< elements that are compared at once: they stay in the caches
/// Each piece that an executor restores takes it the time to hand out all rows to its blocks.
constexpr std::size_t most_pieces = 16;

constexpr std::string_view guard_option = "--guard", witness_option = "--guard-variant";

/// What a kept number is (variants/api/kept_state.hpp).
std::string name_of_number(int number, const Method& method) {
  if (number < int(field_count)) return std::string(field_names[std::size_t(number)]);
  const int low = kept_first_low(method);
  if (number >= low) return fmt::format("low part of {}", field_names[std::size_t(number - low)]);
  if (number == kept_is_started) return "mark of the start";
  const int velocity = number - kept_half_velocities;
  return fmt::format("half-step {}",
                     field_names[std::size_t(velocity < 3 ? vx + velocity : wx + velocity - 3)]);
}

/// @return empty, or why the variant cannot be a witness
std::string why_no_witness(const Plugin& plugin, const RunPlan& plan, bool has_fma) {
  if (plugin.is_distributed) return "it computes by other variants on ranks";
  if (plugin.solves_equations()) return "it does not give out what its methods keep";
  if (plugin.has_fma != has_fma)
    return fmt::format("it {} multiply-adds, the run {}",
                       plugin.has_fma ? "fuses" : "does not fuse", has_fma ? "does" : "does not");
  const auto lack =
      what_lacks(plugin, plan.scene.problem, plan.precision, *plan.method, plan.rotation);
  return lack ? lack->what : "";
}

/// The fastest other variant of this machine that rounds alike and computes by itself; else the
/// variant itself, which finds what does not happen twice.
std::string chosen_witness(const RunPlan& plan, const std::string& variant, bool has_fma) {
  const std::vector<VariantStatus>& all = variants(); // the fastest is the last
  for (auto status = all.rbegin(); status != all.rend(); ++status)
    if (status->is_usable() && !status->is_by_name && status->name != variant &&
        why_no_witness(load_variant(status->name), plan, has_fma).empty())
      return status->name;
  return variant;
}

const Plugin& require_witness(const std::string& name, const RunPlan& plan, bool has_fma) {
  const Plugin& plugin = load_variant(name);
  if (const std::string why = why_no_witness(plugin, plan, has_fma); !why.empty())
    throw InputError(
        fmt::format("--guard-variant {}: {}; give another one, or leave it out", name, why));
  return plugin;
}

[[noreturn]] void refuse_variant(std::string_view option, std::string_view name) {
  throw InputError(fmt::format("{}: variant {} does not give out what its methods keep; give "
                               "another {}",
                               option, name, option == guard_option ? "--variant" : "one"));
}

} // namespace

void require_sound_guard(const RunRequest& request, const RunPlan& plan) {
  const auto refuse = [](const std::string& what) { throw InputError(what); };
  if (request.guard < 0) refuse(fmt::format("--guard {}: give 1 step or more", request.guard));
  if (request.guard == 0) return;
  if (request.guard_steps < 1 || request.guard_steps > request.guard)
    refuse(fmt::format("--guard-steps {}: give 1 to {}, the steps of --guard", request.guard_steps,
                       request.guard));
  if (plan.adaptive) refuse("--guard: steps must be equal; leave --rtol out");
  if (plan.method->has_leaps()) refuse("--guard: leaps have no steps; give another --integrator");
  if (request.samples > 1 || request.repeat_for > 0)
    refuse("--guard: a run that is repeated for its time has none; leave --samples and "
           "--repeat-for out");
  if (plan.plugin->solves_equations()) refuse_variant(guard_option, plan.plugin->name);
  const Plugin& computes =
      plan.plugin->is_distributed ? load_variant(plan.distribution.variant) : *plan.plugin;
  if (request.guard_variant != "auto")
    require_witness(request.guard_variant, plan, computes.has_fma);
}

Guard::Guard(const RunRequest& request, const RunPlan& plan, Executor& run,
             const std::string& variant, bool has_fma)
    : request_(request), plan_(plan), width_(std::size_t(kept_fields(run))) {
  if (width_ == 0) refuse_variant(guard_option, variant);
  const std::string witness = request.guard_variant == "auto"
                                  ? chosen_witness(plan, variant, has_fma)
                                  : request.guard_variant;
  const Plugin& plugin = require_witness(witness, plan, has_fma);
  distribution_ = plan.distribution;
  distribution_.variant = witness;
  if (plan.plugin->is_distributed) distribution_.halo = rank_info(run).halo; // without a trial
  plugin_ = plan.plugin->is_distributed ? plan.plugin : &plugin;
  report_ = {witness, request.guard, request.guard_steps};
}

std::unique_ptr<Executor> Guard::created(Model model) const {
  auto executor =
      plugin_->create({plan_.scene.problem, *plan_.method, model, plan_.precision, plan_.dt,
                       request_.threads, nullptr, &distribution_, "", "", plan_.rotation});
  if (std::size_t(kept_fields(*executor)) != width_)
    refuse_variant(witness_option, report_.witness);
  return executor;
}

std::string Guard::look(Executor& run, Model model, long step) {
  const bool ends = is_end(step), begins = is_begin(step);
  const auto start = Clock::now();
  std::string difference = ends ? of_all(run, compare(run, step)) : "";
  if (begins && difference.empty()) begin(run, model, step, ends);
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
  begin_ = at_ = step;
  const long next = next_multiple(step);
  end_ = report_.steps < next - step ? step + report_.steps : next;
}

std::string Guard::judge_failure(Executor& run, long step, std::size_t element) {
  if (end_ == none) return "";
  const auto start = Clock::now();
  std::string difference = advance_witness(step);
  if (difference.empty()) {
    const Outcome outcome =
        witness_->advance(1, signal_rows(plan_.scene.problem, *plan_.method, plan_.dt, step, 1));
    if (outcome.is_finite || outcome.element != element)
      difference = found(
          step + 1,
          fmt::format("element {} is not finite, and by {} {}", element, report_.witness,
                      outcome.is_finite ? "all are" : fmt::format("it is {}", outcome.element)));
  }
  end_ = none;
  report_.time_s += seconds_since(start);
  return of_all(run, std::move(difference));
}

std::string Guard::go_back(Executor& run, long good, std::span<const double> state, long next) {
  const auto start = Clock::now();
  std::string difference;
  if (end_ != none && good > begin_) {
    difference = advance_witness(good);
    std::vector<double> of_witness(state.size());
    witness_->read(0, of_witness);
    if (difference.empty()) difference = difference_of(state, of_witness, field_count, 0, good);
  }
  if (end_ != none && difference.empty()) difference = compare(run, next);
  forget();
  report_.time_s += seconds_since(start);
  return of_all(run, std::move(difference));
}

long Guard::steps_left(long step, long most) const {
  return std::min(most, (end_ != none ? end_ : next_multiple(step)) - step);
}

void Guard::copy(Executor& run) {
  const std::size_t elements = plan_.scene.problem.lattice.element_count;
  const std::size_t count = std::max(piece, (elements + most_pieces - 1) / most_pieces);
  for (std::size_t first = 0; first < elements; first += count) {
    of_run_.resize(std::min(count, elements - first) * width_);
    save(run, first, of_run_);
    restore(*witness_, first, of_run_);
  }
}

std::string Guard::advance_witness(long step) {
  report_.checked_steps += step - at_;
  while (at_ < step) {
    const long count = std::min(signal_steps, step - at_);
    const Outcome outcome = witness_->advance(
        count, signal_rows(plan_.scene.problem, *plan_.method, plan_.dt, at_, count));
    if (!outcome.is_finite)
      return found(step, fmt::format("element {} is not finite after step {} by {} alone",
                                     outcome.element, at_ + outcome.step, report_.witness));
    at_ += count;
  }
  return "";
}

std::string Guard::difference_of(std::span<const double> of_run, std::span<const double> of_witness,
                                 std::size_t width, std::size_t first, long step) const {
  const auto are_same = [&](double a, double b) {
    return common_bits(a, plan_.precision) == common_bits(b, plan_.precision) ||
           (!std::isfinite(a) && !std::isfinite(b)); // the run will be found unstable
  };
  for (std::size_t n = 0; n < of_run.size(); ++n)
    if (!are_same(of_run[n], of_witness[n]))
      return found(step, fmt::format("{} of element {} became {} and by {} {}",
                                     name_of_number(int(n % width), *plan_.method),
                                     first + n / width, of_run[n], report_.witness, of_witness[n]));
  return "";
}

std::string Guard::found(long step, const std::string& what) const {
  return fmt::format("between steps {} and {}, {}; a processor or memory may be faulty: run it "
                     "elsewhere, or go on from a checkpoint of step {} or before",
                     begin_, step, what, sound_);
}

std::string Guard::of_all(Executor& run, std::string difference) const {
  const std::vector<double> found_by = gather(run, difference.empty() ? 0 : 1);
  const auto first = std::ranges::find(found_by, 1.0);
  if (first == found_by.end() || !difference.empty()) return difference;
  return fmt::format("rank {} computed other bits than its witness", first - found_by.begin());
}

std::string Guard::compare(Executor& run, long step) {
  std::string difference = advance_witness(step);
  end_ = none;
  ++report_.checks;
  const std::size_t elements = plan_.scene.problem.lattice.element_count;
  for (std::size_t first = 0; first < elements; first += piece) {
    of_run_.resize(std::min(piece, elements - first) * width_);
    of_witness_.resize(of_run_.size());
    save(run, first, of_run_); // collective, so for all pieces
    save(*witness_, first, of_witness_);
    if (difference.empty()) difference = difference_of(of_run_, of_witness_, width_, first, step);
  }
  if (difference.empty()) sound_ = step;
  return difference;
}

} // namespace dss
