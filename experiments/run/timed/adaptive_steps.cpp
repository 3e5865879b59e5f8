#include "experiments/run/timed/adaptive_steps.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

/// Shortest step as a share of the end time: a shorter one hardly changes the time.
constexpr double least_share = 1e-12;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

AdaptiveSteps::AdaptiveSteps(Executor& executor, const Problem& problem, const Method& method,
                             const StepTolerance& tolerance, double dt, double end)
    : executor_(executor), problem_(problem), method_(method), tolerance_(tolerance), end_(end),
      control_(tolerance, shortest_edge(problem), dt) {
  for_each_piece(executor, problem.lattice.element_count,
                 [&](std::size_t, std::span<const double> fields) { control_.meet(fields); });
}

std::optional<std::string> AdaptiveSteps::advance_to(double stop) {
  while (time_ < stop) {
    if (visit_before_) visit_before_();
    const double dt = control_.step_within(stop - time_);
    const bool is_last = dt == stop - time_;
    if (step(dt)) {
      time_ = is_last ? stop : time_ + dt;
      if (visit_accepted_) visit_accepted_(time_);
    } else if (control_.dt() < least_share * end_)
      return why_no_step(dt);
  }
  return std::nullopt;
}

bool AdaptiveSteps::step(double dt) {
  const std::vector<double> signals = stage_signals(problem_, method_, time_, dt);
  const double began_s = now_s();
  const StepMaxima maxima = adaptive(executor_).try_step(dt, signals);
  const double tried_s = now_s();
  const bool is_accepted = control_.accept(maxima, dt);
  const double judged_s = now_s();
  if (is_accepted) adaptive(executor_).accept_step();
  const double wall_s = tried_s - began_s + (now_s() - judged_s);
  if (counts_.accepted + counts_.rejected == 0) counts_.first_step_s = wall_s;
  counts_.wall_s += wall_s;
  ++(is_accepted ? counts_.accepted : counts_.rejected);
  if (!is_accepted) return false;
  counts_.least_dt = std::min(counts_.least_dt, dt);
  counts_.largest_dt = std::max(counts_.largest_dt, dt);
  return true;
}

std::string AdaptiveSteps::why_no_step(double dt) {
  std::string what = fmt::format(
      "leaves {:.3g} times the error that --rtol {:g} allows; take a larger --rtol, --atol "
      "above rounding, or a more precise --precision",
      control_.error(), tolerance_.rtol);
  if (!std::isfinite(control_.error())) {
    adaptive(executor_).accept_step(); // gives access to the state after the step
    const auto element = first_not_finite(executor_, problem_.lattice.element_count);
    what = fmt::format("leads to a state that is not finite{}; look at the scene's numbers",
                       element ? fmt::format(", element {}", *element) : " in its error");
  }
  return fmt::format("{}: after {} steps, at t = {:.6g} s, even a step of {:.3g} s {}",
                     problem_.name, counts_.accepted, time_, dt, what);
}

} // namespace dss
