#include "python/core/simulation.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/error.hpp"
#include "solver/model/energy.hpp"
#include "solver/model/stress/stress_field.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/isa/denormals.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

RunPlan plan_of_simulation(const RunRequest& request) {
  const auto refuse = [](const char* what) {
    throw InputError(fmt::format("Simulation: {}; use dssbench.run", what));
  };
  if (request.ranks != 1 || request.variant.starts_with("mpi"))
    refuse("it computes in this process, without ranks");
  if (request.rtol) refuse("its steps are equal, not adaptive");
  if (!request.ensemble.empty()) refuse("it has no ensembles");
  RunPlan plan = plan_run(request);
  if (plan.scene.analysis != "dynamic") refuse("it computes in time, and the scene asks for rest");
  if (plan.model_choice.is_bounded)
    throw InputError("Simulation: model \"auto\" needs a run that watches its error; give a model, "
                     "or use dssbench.run");
  return plan;
}

} // namespace

Simulation::Simulation(RunRequest request)
    : request_(std::move(request)), plan_(plan_of_simulation(request_)) {
  const FlushDenormals flush; // the threads of the executor take the mode over
  executor_ = make_executor(*plan_.plugin, {.problem = problem(),
                                            .method = *plan_.method,
                                            .model = plan_.model,
                                            .precision = plan_.precision,
                                            .dt = plan_.dt,
                                            .threads = request_.threads,
                                            .distribution = &plan_.distribution,
                                            .device = request_.device,
                                            .members = request_.hybrid,
                                            .rotation = plan_.rotation,
                                            .tile = request_.tile});
  write_initial_state(*executor_, problem());
  state_.resize(problem().lattice.element_count * field_count);
}

long Simulation::chunk(long most) const {
  constexpr double piece_s = 0.1;
  const long steps = step_s_ > 0 ? long(std::min(piece_s / step_s_, double(leap_steps))) : 1;
  const long longest = std::min(most, leap_steps);
  return plan_.method->has_leaps() ? longest : std::clamp(steps, 1L, std::max(1L, longest));
}

void Simulation::require_possible(long steps) const {
  if (!breakdown_.empty()) throw UnstableError(breakdown_);
  if (steps < 0) throw InputError(fmt::format("advance({}): give 0 steps or more", steps));
  const long end = step_ + steps;
  std::string why = why_series_too_short(problem(), double(end) * plan_.dt);
  if (why.empty() && plan_.method->is_exponential && end > plan_.steps)
    why = why_not_polynomial(problem(), plan_.dt, end);
  if (!why.empty()) throw InputError(fmt::format("{}: {}", problem().name, why));
}

void Simulation::advance(long steps) {
  require_possible(steps);
  if (steps == 0) return;
  if (is_busy_.exchange(true)) refuse_busy();
  const auto start = Clock::now();
  breakdown_ = "an earlier call of advance() ended in the middle; set the state";
  is_current_ = false;
  try {
    advance_whole(steps);
  } catch (...) {
    is_busy_ = false;
    throw;
  }
  breakdown_.clear();
  step_ += steps;
  step_s_ = seconds_since(start) / double(steps);
  is_busy_ = false;
}

void Simulation::advance_whole(long steps) {
  const FlushDenormals flush;
  const Outcome outcome =
      executor_->advance(steps, signal_rows(problem(), *plan_.method, plan_.dt, step_, steps));
  if (outcome.is_finite) return;
  breakdown_ =
      fmt::format("{}: {}", problem().name, breakdown_reason(plan_, outcome, step_ + outcome.step));
  throw UnstableError(breakdown_);
}

void Simulation::refuse_busy() const {
  throw InputError(fmt::format("{}: another thread advances it; wait for that", problem().name));
}

std::span<const double> Simulation::state() {
  if (is_busy_) refuse_busy();
  if (!is_current_) executor_->read(0, state_);
  is_current_ = true;
  return state_;
}

void Simulation::set_state(std::span<const double> state) {
  if (is_busy_) refuse_busy();
  if (state.size() != state_.size())
    throw InputError(fmt::format("state: {} numbers; {} has {} elements of {}", state.size(),
                                 problem().name, state_.size() / field_count, int(field_count)));
  if (const auto element = first_not_finite(state))
    throw InputError(fmt::format("state: element {} has a number that is not finite", *element));
  const FlushDenormals flush;
  executor_->write(0, state);
  is_current_ = false;
  breakdown_.clear();
}

Rotation Simulation::equations() const { return equations_of(plan_, plan_.model); }
std::vector<double> Simulation::signals() const { return signals_at(problem(), time()); }

std::vector<SymmetricTensor> Simulation::stress() {
  const StressField field(problem(), state(), equations(), signals());
  std::vector<SymmetricTensor> stress;
  for (const ElementStress& element : field.elements()) stress.push_back(element.stress);
  return stress;
}

double Simulation::energy() { return total_energy(problem(), state(), equations()); }

std::string Simulation::digest() {
  if (is_busy_) refuse_busy();
  return fmt::format("{:016x}",
                     state_digest(*executor_, problem().lattice.element_count, plan_.precision));
}

std::vector<std::array<double, 3>> Simulation::places() const {
  std::vector<std::array<double, 3>> places;
  problem().lattice.for_each_element([&](std::size_t, const Row& row, int x) {
    places.push_back(rest_position(problem(), row, x));
  });
  return places;
}

void Simulation::write_picture(const std::string& path) {
  if (!path.ends_with(".svg"))
    throw InputError(fmt::format("picture {}: give a name that ends in .svg", path));
  const std::span<const double> now = state();
  FileSet outputs;
  RunRequest wanted;
  wanted.picture = path;
  write_final_files(outputs, wanted, problem(), {now.begin(), now.end()}, equations(), signals());
  outputs.commit();
}

} // namespace dss
