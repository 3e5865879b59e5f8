#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/plan/job.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/decomposition/decomposition_file.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/memory.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"
#include "solver/numerics/stability.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

Rotation chosen_rotation(const std::string& text) {
  if (const auto rotation = find_rotation(text)) return *rotation;
  throw InputError(fmt::format("--rotation {}: unknown rotation; {}", text,
                               nearest_name(text, names_of("ROTATION"))));
}

/// The variant of this process, and the variant of the parts on several ranks.
VariantName asked_variant(const RunRequest& request) {
  if (request.hybrid.empty()) return parse_variant(request.variant, request.ranks);
  if (request.variant != "auto" && request.variant != "hybrid")
    throw InputError(fmt::format(
        "--hybrid: its members are variants, and --variant {} another; give one of the two options",
        request.variant));
  if (!request.device.empty())
    throw InputError(
        fmt::format("--device {}: the members of --hybrid name their devices: opencl@{}",
                    request.device, request.device));
  if (request.hybrid == "auto" && request.ranks > 1)
    throw InputError(
        "--hybrid auto: chooses members within one process; with --ranks list them: avx512,opencl");
  return request.ranks > 1 ? VariantName{"mpi", "auto"} : VariantName{"hybrid", ""};
}

/// Rejects a variant that cannot run here, or not on this device, or not in this precision.
void require_device(const Plugin& plugin, const std::string& device, Precision precision) {
  if (const std::string why = plugin.why_unusable == nullptr ? "" : plugin.why_unusable();
      !why.empty())
    throw InputError(fmt::format("variant {} cannot run here: {}", plugin.name, why));
  if (plugin.devices != nullptr)
    require_precision(choose_device(plugin.devices(), device), precision);
  else if (!device.empty())
    throw InputError(fmt::format("--device {}: variant {} runs on this CPU; give --variant opencl",
                                 device, plugin.name));
}

/// Applies require_device to all variants that compute: the variant itself, that of the parts, or
/// each member of a hybrid.
void require_devices(const RunRequest& request, const RunPlan& plan) {
  if (request.hybrid.empty() || request.hybrid == "auto") {
    const Plugin& plugin =
        plan.plugin->is_distributed ? load_variant(plan.distribution.variant) : *plan.plugin;
    return require_device(plugin, request.device, plan.precision);
  }
  for (const Member& member : parse_members(request.hybrid)) {
    try {
      require_device(load_variant(member.variant), member.device, plan.precision);
    } catch (const InputError& error) {
      throw InputError(fmt::format("--hybrid: member {}: {}", name(member), error.what()));
    }
  }
}

/// More is beyond a lifetime. Options read larger numbers as the largest of their type.
constexpr long most_steps_of_run = 1'000'000'000'000'000;
constexpr int most_frames_of_run = 1'000'000;
constexpr long most_rows_of_history = 1'000'000;

/// Names and numbers of output files.
void require_sensible_files(const RunRequest& request) {
  const auto refuse = [](const std::string& what) { throw InputError(what); };
  if (request.frames < 0) refuse(fmt::format("--frames {}: give 0 or more", request.frames));
  if (request.frames > 0 && request.output.empty())
    refuse("--frames: needs --output F.vtu, which names the series");
  if (!request.picture.empty() && !request.picture.ends_with(".svg"))
    refuse(fmt::format("--picture {}: give a name that ends in .svg", request.picture));
  const bool is_one_file = request.output.ends_with(".vtkhdf");
  if (!request.output.empty() && !request.output.ends_with(".vtu") && !is_one_file)
    refuse(fmt::format("--output {}: give a name that ends in .vtu or .vtkhdf", request.output));
  if (is_one_file && request.has_checkpoint())
    refuse(fmt::format("--output {}: a checkpoint cannot go on with a series in one file; give "
                       "F.vtu",
                       request.output));
}

void require_sensible(const RunRequest& request, const RunPlan& plan) {
  const auto refuse = [](const std::string& what) { throw InputError(what); };
  const auto require_at_most = [&](const char* option, long value, long most) {
    if (value > most) refuse(fmt::format("{} {}: give at most {}", option, value, most));
  };
  require_at_most("--steps", plan.steps, most_steps_of_run);
  require_at_most("--warmup", request.warmup_steps, most_steps_of_run);
  require_at_most("--samples", request.samples, most_steps_of_run);
  require_at_most("--frames", request.frames, most_frames_of_run);
  if (request.threads < 1 || request.threads > 1024)
    refuse(fmt::format("--threads {}: give 1 to 1024", request.threads));
  if (request.threads > 1 && !plan.plugin->is_threaded)
    refuse(fmt::format("--threads {}: variant \"{}\" runs on one thread; give --threads 1",
                       request.threads, plan.plugin->name));
  if (request.tile > 0 && !plan.plugin->has_tiles)
    refuse(fmt::format("--tile {}: variant \"{}\" has no tiles; give another --variant, or none",
                       request.tile, plan.plugin->name));
  if (request.ranks < 1 || request.ranks > 65536)
    refuse(fmt::format("--ranks {}: give 1 to 65536", request.ranks));
  if (const JobRank job = job_rank(); job.is_started && request.ranks != job.ranks)
    refuse(fmt::format("--ranks {}: this job has {}; give --ranks {}, or none", request.ranks,
                       job.ranks, job.ranks));
  if (request.shares == "measured" && is_file(request.decomposition))
    refuse("--shares measured: the parts are in the file of --decomposition; give a method, or "
           "--shares equal");
  if (!request.is_member && std::size_t(request.ranks) > plan.scene.problem.lattice.element_count)
    refuse(fmt::format("--ranks {}: the scene has {} elements; give at most that", request.ranks,
                       plan.scene.problem.lattice.element_count));
  if (request.halo != "auto") asked_halo_strategy(request.halo, request.threads);
  if (request.shares != "equal" && request.shares != "measured")
    refuse(fmt::format("--shares {}: unknown; {}", request.shares,
                       nearest_name(request.shares, names_of("SHARES"))));
  if (const std::vector<std::string> known = names_of("DECOMPOSITION");
      !is_file(request.decomposition) &&
      std::ranges::find(known, request.decomposition) == known.end())
    refuse(fmt::format("--decomposition {}: unknown method; {}", request.decomposition,
                       nearest_name(request.decomposition, known)));
  if (!(plan.dt > 0) || !std::isfinite(plan.dt))
    refuse(fmt::format("--dt {:g}: the step must be positive [s]", plan.dt));
  if (plan.steps < 1) refuse(fmt::format("--steps {}: give at least 1", plan.steps));
  if (request.warmup_steps < 0)
    refuse(fmt::format("--warmup {}: give 0 or more", request.warmup_steps));
  if (!(request.warmup_s >= 0) || !std::isfinite(request.warmup_s))
    refuse(fmt::format("--warmup-time {:g}: give 0 s or more", request.warmup_s));
  if (request.check_tail < 0)
    refuse(fmt::format("--check-tail {}: give 0 or more", request.check_tail));
  if (request.stability_limit && !(*request.stability_limit > 0))
    refuse(fmt::format("--stability-limit {:g}: the step must be positive [s]",
                       *request.stability_limit));
  if (!(request.repeat_for >= 0) || !std::isfinite(request.repeat_for))
    refuse(fmt::format("--repeat-for {:g}: give 0 s or more", request.repeat_for));
  if (request.samples < 1) refuse(fmt::format("--samples {}: give at least 1", request.samples));
  if (request.repeat_for > 0 && request.ranks > 1)
    refuse("--repeat-for: only a run on 1 rank starts again");
  require_sensible_files(request);
}

/// Tolerance from --rtol and --atol; empty without them.
std::optional<StepTolerance> chosen_tolerance(const RunRequest& request, const Method& method,
                                              Precision precision) {
  const auto refuse = [](const std::string& what) { throw InputError(what); };
  if (!request.rtol) {
    if (request.atol)
      refuse(
          fmt::format("--atol {:g}: only with --rtol, which makes steps adaptive", *request.atol));
    return std::nullopt;
  }
  if (method.name != dopri5_adaptive().name)
    refuse(fmt::format("--rtol {:g}: {} has no adaptive steps; give --integrator {}", *request.rtol,
                       method.name, dopri5_adaptive().name));
  if (!(*request.rtol > 0) || !std::isfinite(*request.rtol))
    refuse(fmt::format("--rtol {:g}: give a positive number, 1e-6 for one", *request.rtol));
  const double atol = request.atol.value_or(0);
  if (!(atol >= 0) || !std::isfinite(atol))
    refuse(fmt::format("--atol {:g}: give 0 or more", atol));
  // Rounding alone gives an error estimate of some units in the last place. With a smaller
  // tolerance no step would be short enough.
  const double least = 4 * (is_single(precision) ? double(std::numeric_limits<float>::epsilon())
                                                 : std::numeric_limits<double>::epsilon());
  if (*request.rtol < least && atol == 0)
    refuse(fmt::format("--rtol {:g}: is below the rounding of {}; give {:.2g} or more, or --atol",
                       *request.rtol, name(precision), least));
  return StepTolerance{*request.rtol, atol};
}

OracleState expected_state(const RunRequest& request, const RunPlan& plan) {
  OracleState expected = read_oracle_state(request.check_state);
  if (request.check_step != 0 && request.check_step != expected.steps)
    throw InputError(fmt::format("--check-step {}: {} has the state at step {}", request.check_step,
                                 request.check_state, expected.steps));
  if (expected.state.size() != plan.scene.problem.lattice.element_count * field_count)
    throw InputError(fmt::format("--check-state {}: has {} elements, the scene {}",
                                 request.check_state, expected.state.size() / field_count,
                                 plan.scene.problem.lattice.element_count));
  if (expected.steps < 1 || expected.steps > plan.steps)
    throw InputError(fmt::format("--check-step {}: the run has {} steps; give 1 to that",
                                 expected.steps, plan.steps));
  return expected;
}

/// Reads the solution, and sets the number of steps to match its saved times.
/// @throws InputError if the run cannot be compared with it
void read_reference(const RunRequest& request, RunPlan& plan) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("--reference {}: {}", request.reference, what));
  };
  plan.reference = read_solution(request.reference);
  const std::size_t elements = plan.reference->states.front().size() / field_count;
  if (elements != plan.scene.problem.lattice.element_count)
    refuse(fmt::format("has {} elements, the scene {}", elements,
                       plan.scene.problem.lattice.element_count));
  try {
    plan.steps_between = plan.reference->times.whole_steps_between(plan.dt);
  } catch (const InputError& error) {
    refuse(error.what());
  }
  plan.steps = plan.steps_between * plan.reference->times.count;
  if (request.steps && *request.steps != plan.steps)
    refuse(fmt::format("ends at {:.6g} s: give --steps {}, or none", plan.reference->times.end,
                       plan.steps));
}

std::string why_run_has_no_watch(const RunRequest& request, const RunPlan& plan) {
  if (request.is_member) return "it is one of an ensemble";
  if (request.ranks > 1) return "it is one on several ranks";
  if (!request.hybrid.empty()) return "it is one of a hybrid";
  if (plan.adaptive) return "its steps are adaptive";
  return why_no_watch(*plan.method);
}

ModelChoice chosen_model(const RunRequest& request, const RunPlan& plan) {
  const Problem& problem = plan.scene.problem;
  const std::string asked =
      request.model.value_or(request.is_model_auto ? plan.scene.asked_model : plan.scene.model);
  const double tolerance =
      require_model_tolerance(request.model_tolerance.value_or(plan.tolerance().run));
  if (request.on_bound != "promote" && request.on_bound != "stop")
    throw InputError(fmt::format("--on-bound {}: unknown; {}", request.on_bound,
                                 nearest_name(request.on_bound, names_of("BOUND"))));
  if (asked == "auto" && plan.rotation != Rotation::quaternion)
    return {asked, Model::spatial, fmt::format("--rotation {} is one of it", name(plan.rotation)),
            {},    tolerance,      false};
  if (asked == "auto") return choose_model(problem, tolerance, why_run_has_no_watch(request, plan));
  const auto model = find_model(asked);
  if (!model)
    throw InputError(fmt::format("--model {}: unknown model; {}", asked,
                                 nearest_name(asked, model_names_and_auto())));
  if (const std::string why = why_not(*model, problem); !why.empty())
    throw InputError(fmt::format("--model {}: {}: {}; use --model spatial, or auto", asked,
                                 plan.scene.name, why));
  return {asked, *model, "asked for", {}, tolerance, false};
}

/// @throws InputError if the method is exponential, and something rules it out
void require_exponential(const RunRequest& request, const RunPlan& plan) {
  if (!plan.method->is_exponential) return;
  const Problem& problem = plan.scene.problem;
  std::string why =
      why_not_exponential(*plan.method, problem, plan.model, plan.precision, plan.rotation);
  if (request.is_member) why = "has no ensembles; give another --integrator";
  if (why.empty()) why = why_not_polynomial(problem, plan.dt, plan.steps);
  if (!why.empty()) throw InputError(fmt::format("--integrator {}: {}", plan.method->name, why));
}

} // namespace

void require_outputs_writable(const RunRequest& request) {
  for (const std::string& path :
       {request.output, request.state_csv, request.picture, request.history, request.checkpoint,
        request.json == "-" ? std::string() : request.json})
    if (!path.empty()) require_writable(path);
}

Precision require_precision_name(const std::string& name) {
  if (const auto precision = find_precision(name)) return *precision;
  throw InputError(fmt::format("--precision {}: unknown precision; {}", name,
                               nearest_name(name, names_of("PRECISION"))));
}

double require_model_tolerance(double tolerance) {
  if (tolerance > 0 && std::isfinite(tolerance)) return tolerance;
  throw InputError(
      fmt::format("--model-tolerance {:g}: give a positive number, 1e-3 for one", tolerance));
}

const Method& require_method(const std::string& name) {
  if (const Method* method = find_method(name)) return *method;
  throw InputError(fmt::format("--integrator {}: {}", name, why_no_method(name)));
}

double require_stable(const Problem& problem, const Method& method, double dt, bool is_forced,
                      std::optional<double> known) {
  StabilityLimit limit;
  if (known) {
    limit.dt = *known;
    limit.how = "as --stability-limit says";
  } else {
    limit = stable_step(problem, method);
  }
  if (!known && dt > limit.dt && problem.lattice.element_count <= sharp_stability_elements)
    limit = stable_step(problem, method, true);
  if (dt > limit.dt && !is_forced)
    throw UnstableError(fmt::format("{}: dt = {:.6g} s is above the stability limit {:.6g} s of {} "
                                    "here ({}); take a smaller --dt, or "
                                    "--force to run anyway",
                                    problem.name, dt, limit.dt, method.name, limit.how));
  return limit.dt;
}

/// Refuses a state that cannot fit. A rank has its part alone, and devices have memory of their
/// own.
/// @param fields  numbers of an element that the state has at least
void require_room(const RunRequest& request, double elements, int fields, Precision precision) {
  if (request.variant.starts_with("opencl") || request.variant == "hybrid" ||
      !request.hybrid.empty())
    return;
  const double number = precision == Precision::f64 ? sizeof(double) : sizeof(float);
  const int states = request.guard > 0 ? 2 : 1;
  require_memory(states * elements * fields * number / std::max(1, request.ranks),
                 fmt::format("{}: the states of {:.0f} elements", request.scene, elements),
                 "give the scene fewer elements");
}

/// Rows of a history whose interval nobody gave. A row costs as much as some steps, and ends an
/// adaptive step.
long usual_rows(std::size_t elements, bool is_adaptive) {
  constexpr long most_looked_at = 20'000'000; // elements of all rows
  return std::clamp(most_looked_at / long(elements), 10L, is_adaptive ? 100L : 1000L);
}

/// @param every  0: usual_rows
std::vector<long> history_steps(long every, const RunPlan& plan) {
  const long steps = plan.steps;
  if (every < 0) throw InputError(fmt::format("--every {}: give 1 step or more", every));
  if (every == 0) {
    const long rows =
        usual_rows(plan.scene.problem.lattice.element_count, plan.adaptive.has_value());
    every = (steps + rows - 1) / rows;
  }
  if (steps / every > most_rows_of_history)
    throw InputError(fmt::format("--every {}: {} steps would have {} rows; give at least {}", every,
                                 steps, steps / every,
                                 (steps + most_rows_of_history - 1) / most_rows_of_history));
  std::vector<long> of_rows;
  for (long step = 0; step < steps; step += every) of_rows.push_back(step);
  of_rows.push_back(steps);
  return of_rows;
}

RunPlan plan_run(const RunRequest& request) {
  RunPlan plan;
  plan.precision = require_precision_name(request.precision.value_or("f64"));
  // Before it is built. Each model has a displacement and a velocity at least.
  const ShapeSize size = scene_size(request.scene, request.overrides);
  require_room(request, size.least_elements, 2, plan.precision);
  plan.scene = load_scene(request.scene, request.overrides);
  const Problem& problem = plan.scene.problem;
  const VariantName variant = asked_variant(request);
  plan.plugin = &load_variant(variant.name);
  plan.distribution = {request.ranks, variant.part, request.decomposition, request.halo,
                       request.shares == "measured"};
  plan.method = &require_method(request.integrator.value_or(problem.integrator));
  plan.rotation =
      chosen_rotation(request.rotation.value_or(std::string(name(plan.plugin->rotation))));
  plan.dt = request.dt.value_or(problem.dt);
  plan.steps = request.steps.value_or(problem.steps);
  if (plan.dt > 0 && std::isfinite(plan.dt)) {
    plan.fitted = std::make_shared<const Method>(fitted(problem, *plan.method, plan.dt));
    plan.method = plan.fitted.get();
  }
  plan.tail_steps = request.check_tail;
  if (!request.reference.empty() && plan.dt > 0) read_reference(request, plan);
  require_devices(request, plan);
  if (const auto lack =
          what_lacks(*plan.plugin, problem, plan.precision, *plan.method, plan.rotation))
    throw InputError(fmt::format("{}: variant {} {}; give {}", lack->asked_by, plan.plugin->name,
                                 lack->what, lack->remedy));
  require_sensible(request, plan);
  if (const std::string why = why_series_too_short(problem, double(plan.steps) * plan.dt);
      !why.empty())
    throw InputError(fmt::format("{}: {}", problem.name, why));
  if (request.is_root) require_outputs_writable(request);
  plan.adaptive = chosen_tolerance(request, *plan.method, plan.precision);
  plan.model_choice = chosen_model(request, plan);
  plan.model = plan.model_choice.chosen;
  require_exponential(request, plan);
  require_room(request, double(problem.lattice.element_count),
               int(descriptor(plan.model).fields.size()), plan.precision);
  plan.stability_limit = require_stable(
      problem, *plan.method, plan.dt, request.is_forced || plan.adaptive, request.stability_limit);
  if (plan.adaptive) plan.method = &dopri5_adaptive();
  if (!request.check_state.empty()) plan.expected = expected_state(request, plan);
  for (int frame = 0; frame <= request.frames && !request.output.empty(); ++frame) {
    const double share = request.frames == 0 ? 1 : double(frame) / request.frames;
    plan.frame_steps.push_back(std::lround(share * double(plan.steps)));
  }
  plan.frame_steps.erase(std::unique(plan.frame_steps.begin(), plan.frame_steps.end()),
                         plan.frame_steps.end());
  plan.probes = read_probes(request.probes, problem);
  if (!request.history.empty()) plan.history_steps = history_steps(request.every, plan);
  return plan;
}

} // namespace dss
