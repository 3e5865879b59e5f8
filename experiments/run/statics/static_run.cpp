#include "experiments/base/clock.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/run/plan/probe.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "experiments/run/statics/analysis_model.hpp"
#include "experiments/run/statics/relaxation.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/statics/held.hpp"
#include "variants/isa/denormals.hpp"

#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr double step_share = 0.95; ///< relative to the largest stable step
constexpr int most_tries = 4;       ///< each with half the step

Preconditioner chosen_preconditioner(const std::string& name) {
  if (name == "incomplete_cholesky") return Preconditioner::incomplete_cholesky;
  if (name == "block_jacobi") return Preconditioner::block_jacobi;
  throw InputError(fmt::format("--preconditioner {}: unknown; {}", name,
                               nearest_name(name, names_of("PRECONDITIONER"))));
}

/// Degrees of freedom that are unknown. If nothing leaves the plane, only motion in the plane is
/// unknown. For linear equations, the smallest linear model gives the unknowns.
std::uint8_t unknowns_of(Model model, const Problem& problem) {
  if (degrees_of(model) != dof_all) return degrees_of(model);
  if (model == Model::linear) return degrees_of(smallest_linear(problem));
  return why_not_planar(problem).empty() ? degrees_of(Model::planar) : std::uint8_t(dof_all);
}

/// Says if a planar equilibrium is unstable against motion out of its plane; empty if it is stable.
/// `fields` has 13 numbers per element.
std::string out_of_plane(const Problem& problem, double loads, const std::vector<double>& fields) {
  try {
    StaticSystem across(problem, Rotation::quaternion, degrees_of(Model::bending), loads);
    const SparseMatrix tangent = across.tangent(across.inside(fields));
    Factors factors;
    factors.compute(tangent);
    if (!factors.are_complete() || factors.zero_pivot(tangent))
      return "out of its plane, into which nothing pushes it, some motion takes no force";
    if (factors.negative_pivots() > 0)
      return "out of its plane, into which nothing pushes it, it is not stable";
  } catch (const InputError&) { // all motion out of the plane is clamped
  }
  return {};
}

/// Note on stability out of the plane. It applies if nobody asked for a planar model, but the
/// solution was restricted to the plane because nothing pushes it out. Empty if the state is stable
/// there, or if the requested model has no such motion.
std::string stability_note(const Problem& problem, const AnalysisModel& of, double loads,
                           const AnalysisResult& result) {
  const bool is_whole = of.is_auto || degrees_of(of.model) == dof_all;
  if (result.status != "ok" || !is_whole || is_linear(of.model) ||
      unknowns_of(of.model, problem) == dof_all)
    return {};
  if (result.linear_solver == "direct") return out_of_plane(problem, loads, result.state);
  return fmt::format("whether it is stable out of its plane is not known: {} not say",
                     result.solver == "relaxation" ? "relaxation in the plane does"
                                                   : "conjugate gradients do");
}

void describe(const Problem& problem, Model model, double loads, AnalysisResult& result) {
  StaticSystem system(problem, rotation_of(model), unknowns_of(model, problem), loads);
  result.residual = system.residual(system.inside(result.state));
  const auto [energy_j, reactions] =
      energy_and_reactions(problem, result.state, rotation_of(model), system.signals());
  result.signals.assign(system.signals().begin(), system.signals().end());
  result.energy_j = energy_j;
  result.reactions = reactions;
  for (std::size_t e = 0; e < result.elements; ++e) {
    const double* f = &result.state[e * field_count];
    result.max_displacement_m = std::max(result.max_displacement_m,
                                         std::sqrt(f[ux] * f[ux] + f[uy] * f[uy] + f[uz] * f[uz]));
  }
}

void solve_equations(const Problem& problem, Model model, const std::string& solver,
                     const AnalysisRequest& request, AnalysisResult& result) {
  EquilibriumOptions options;
  options.preconditioner = chosen_preconditioner(request.preconditioner);
  if (solver == "direct") options.solver = SolverKind::direct;
  if (solver == "cg") options.solver = SolverKind::cg;
  const auto start = Clock::now();
  StaticSystem system(problem, rotation_of(model), unknowns_of(model, problem), request.loads);
  const Equilibrium found = find_equilibrium(system, options);
  result.state = system.fields(found.state);
  result.wall_s = seconds_since(start);
  result.linear_solver = found.solver;
  result.solver = !is_linear(model) ? "newton" : found.solver == "direct" ? "direct" : "cg";
  result.unknowns = long(system.size());
  result.iterations = found.iterations;
  result.matrices = found.matrices;
  result.cg_iterations = found.cg_iterations;
  if (!found.is_found) result.status = "not converged", result.reason = found.reason;
  result.note = found.note;
}

/// Runs a relaxation. The variant, method and precision are those of a run; the step is the largest
/// stable one.
void relax_to_rest(const RunRequest& run, Model model, const AnalysisRequest& request,
                   AnalysisResult& result) {
  RunRequest asked = run;
  asked.model = name(model);
  asked.integrator = run.integrator.value_or("velocity_verlet");
  asked.is_forced = true; // the scene's step is not used
  asked.steps = 1;
  asked.output.clear(), asked.state_csv.clear(), asked.picture.clear();
  const RunPlan plan = plan_run(asked);
  if (plan.method->is_unlimited() || plan.plugin->is_distributed)
    throw InputError(fmt::format("--solver relaxation: runs an explicit method on one process; {}",
                                 plan.method->is_unlimited() ? "give --integrator velocity_verlet"
                                                             : "leave --ranks out"));
  const Problem& problem = plan.scene.problem;
  if (const std::string why = why_not_held(problem, unknowns_of(model, problem)); !why.empty())
    throw InputError(fmt::format("{}: {}", problem.name, why));
  const Problem relaxed = relaxed_problem(problem, request.masses == "scaled", request.loads);
  const double loads =
      StaticSystem(problem, rotation_of(model), degrees_of(model), request.loads).load_norm();
  const Method method = fitted(relaxed, require_method(*asked.integrator), plan.dt);
  RelaxationSettings settings{request.tolerance,
                              run.steps.value_or(RelaxationSettings{}.most_steps),
                              step_share * stable_step(relaxed, method).dt};
  flush_denormals();
  const auto start = Clock::now();
  Relaxation found;
  for (int tried = 0; tried < most_tries;
       ++tried, settings.dt /= 2) { // stretched bodies may vibrate faster than bodies at rest
    const auto executor =
        plan.plugin->create({relaxed, method, plan.model, plan.precision, settings.dt, run.threads,
                             nullptr, &plan.distribution, run.device, run.hybrid, plan.rotation});
    found = relax(*executor, relaxed, method, plan.precision, loads, settings);
    result.steps += found.steps;
    if (found.is_finite) break;
  }
  result.wall_s = seconds_since(start);
  result.state = found.state;
  result.dt_s = settings.dt;
  result.solver = "relaxation";
  result.variant = plan.plugin->name;
  result.isa = plan.plugin->isa;
  result.precision = name(plan.precision);
  result.integrator = method.name;
  result.threads = run.threads;
  result.iterations = found.peaks;
  result.unknowns = long(free_dofs(problem, degrees_of(model)).size());
  if (!found.is_settled) result.status = "not converged", result.reason = found.reason;
  if (found.is_settled) result.note = found.reason;
}

} // namespace

AnalysisResult solve_static(const RunRequest& run, const AnalysisRequest& request) {
  const std::string solver = request.solver;
  if (solver != "relaxation") use_threads_for_factors(run.threads);
  if (request.masses != "scaled" && request.masses != "scene")
    throw InputError(fmt::format("--masses {}: unknown; {}", request.masses,
                                 nearest_name(request.masses, names_of("MASSES"))));
  if (!(request.tolerance > 0))
    throw InputError(fmt::format("--tolerance {:g}: give a positive number", request.tolerance));
  const Scene scene = load_scene(run.scene, run.overrides);
  read_probes(run.probes, scene.problem); // mistakes are found before the solution
  if (const std::string why =
          why_series_too_short(scene.problem, double(scene.problem.steps) * scene.problem.dt);
      !why.empty())
    throw InputError(fmt::format("{}: {}", scene.name, why));
  const AnalysisModel of = static_model(run, scene, solver);
  const Model model = of.model;
  AnalysisResult result;
  result.analysis = "static";
  result.scene = scene.name;
  result.model = name(model);
  result.model_why = of.why;
  result.elements = scene.problem.lattice.element_count;
  result.links = scene.problem.link_count();
  if (solver == "relaxation")
    relax_to_rest(run, model, request, result);
  else
    solve_equations(scene.problem, model, solver, request, result);
  describe(scene.problem, model, request.loads, result);
  if (const std::string note = stability_note(scene.problem, of, request.loads, result);
      !note.empty())
    result.note += (result.note.empty() ? "" : "; ") + note;
  return result;
}

} // namespace dss
