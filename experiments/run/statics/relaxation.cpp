#include "experiments/run/statics/relaxation.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/numerics/linearised.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/orientation.hpp"
#include "solver/statics/static_system.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace dss {
namespace {

constexpr long looks_between_peaks = 24; ///< checks of the kinetic energy between two peaks
constexpr long most_steps_between = 256; ///< largest number of steps between two checks
/// this many peaks without a smaller residual mean that rounding holds it
constexpr long peaks_without_gain = 150;
/// largest residuals at which rounding is accepted as the cause
constexpr double accepted_f64 = 1e-8, accepted_f32 = 1e-2;

/// Largest stiffness of an element of each body, for each of its six degrees of freedom (u, theta).
std::vector<Vector6> largest_stiffness(const Problem& problem) {
  const Linearised system(problem);
  std::vector<Vector6> own(system.body.size(), system.tie_stiffness),
      of_body(problem.bodies.size(), Vector6::Zero());
  for (const auto& [i, j, kind] : system.links) {
    own[i] += system.kinds[kind].k.diagonal().head<6>();
    own[j] += system.kinds[kind].k.diagonal().tail<6>();
  }
  for (const PressureTerm& term : system.pressures)
    for (const auto& [dof, coefficient] : term.parts)
      own[dof / 6][Eigen::Index(dof % 6)] += term.weight * coefficient * coefficient;
  for (std::size_t e = 0; e < own.size(); ++e) {
    Vector6& body = of_body[std::size_t(system.body[e])];
    body = body.cwiseMax(own[e]);
  }
  return of_body;
}

void scale_masses(Problem& problem) {
  for (Body& body : problem.bodies) body.mass_ratios.clear(); // masses are chosen, not given
  const std::vector<Vector6> stiffness = largest_stiffness(problem);
  // squared time: mass = stiffness * square
  double square = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < stiffness.size(); ++b)
    if (const double k = stiffness[b].head<3>().maxCoeff(); k > 0)
      square = std::min(square, problem.bodies[b].mass / k);
  if (!std::isfinite(square)) return;
  for (std::size_t b = 0; b < stiffness.size(); ++b) {
    const double along = stiffness[b].head<3>().maxCoeff(),
                 about = stiffness[b].tail<3>().maxCoeff();
    if (along > 0) problem.bodies[b].mass = square * along;
    if (about > 0) problem.bodies[b].inertia.fill(square * about);
  }
}

/// The loop of dynamic relaxation with kinetic damping.
class KineticDamping {
public:
  KineticDamping(Executor& executor, const Problem& problem, const Method& method, double load_norm,
                 const RelaxationSettings& settings)
      : executor_(executor), method_(method), load_norm_(load_norm), settings_(settings),
        edge_(shortest_edge(problem)), state_(problem.lattice.element_count * field_count, 0.0),
        rates_(state_.size()) {
    problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
      body_.push_back(&problem.bodies[std::size_t(row.body)]);
      mass_ratio_.push_back(problem.mass_ratio(e, *body_.back()));
    });
    signals_ = signal_rows(problem, method, settings.dt, 0, 1);
    signals_.resize(signal_count(problem));
  }

  Relaxation run(double accepted) {
    stand_still();
    found_.residual = residual();
    double best = found_.residual;
    long best_peak = 0;
    while (found_.residual > settings_.tolerance && found_.reason.empty()) {
      if (!advance_past_peak()) break;
      found_.residual = residual();
      if (found_.residual < 0.7 * best) best = found_.residual, best_peak = found_.peaks;
      if (found_.peaks - best_peak > peaks_without_gain)
        found_.reason = fmt::format("unbalanced forces stopped falling at {:.2g} of the loads",
                                    found_.residual);
      else if (found_.steps >= settings_.most_steps)
        found_.reason = fmt::format(
            "unbalanced forces are {:.2g} of the loads after {} steps; give more --steps",
            found_.residual, found_.steps);
    }
    found_.is_settled =
        found_.residual <= settings_.tolerance ||
        (found_.is_finite && found_.residual <= accepted && found_.steps < settings_.most_steps);
    found_.state = state_;
    return found_;
  }

private:
  void stand_still() {
    for (std::size_t e = 0; e < body_.size(); ++e)
      for (const int field : {vx, vy, vz, wx, wy, wz})
        state_[e * field_count + std::size_t(field)] = 0;
    executor_.write(0, state_);
  }

  /// Runs until the kinetic energy falls. Then returns to the state of the check before, at rest.
  /// @return true if all numbers stayed finite
  bool advance_past_peak() {
    std::vector<double> now(state_.size());
    long since = 0;
    for (double last = 0;;) {
      const long steps = std::min(steps_between_, settings_.most_steps - found_.steps);
      const Outcome outcome = executor_.advance(steps, repeated(steps * method_.stages + 1));
      if (!outcome.is_finite) {
        found_.reason = breakdown_text(outcome.what, found_.steps + outcome.step, settings_.dt,
                                       outcome.element);
        found_.is_finite = false;
        return false;
      }
      found_.steps += steps;
      since += steps;
      executor_.read(0, now);
      const double energy = kinetic_energy(now);
      if (!(energy >= last)) break;
      last = energy;
      state_.swap(now);
      if (found_.steps >= settings_.most_steps) break;
      if (since > 2 * looks_between_peaks * steps_between_) look_less_often(since);
    }
    ++found_.peaks;
    look_less_often(since);
    stand_still();
    return true;
  }
  /// Sets the interval so that looks_between_peaks checks fit between two peaks.
  void look_less_often(long since) {
    steps_between_ = std::clamp(since / looks_between_peaks, 1L, most_steps_between);
  }

  std::vector<double> repeated(long rows) const {
    std::vector<double> all;
    all.reserve(std::size_t(rows) * signals_.size());
    for (long row = 0; row < rows; ++row) all.insert(all.end(), signals_.begin(), signals_.end());
    return all;
  }

  double kinetic_energy(const std::vector<double>& state) const {
    double energy = 0;
    for (std::size_t e = 0; e < body_.size(); ++e) {
      const double* f = &state[e * field_count];
      for (std::size_t a = 0; a < 3; ++a)
        energy += mass_ratio_[e] * (body_[e]->mass * f[vx + a] * f[vx + a] +
                                    body_[e]->inertia[a] * f[wx + a] * f[wx + a]);
    }
    return energy / 2;
  }

  /// Unbalanced forces at rest, relative to the loads. They equal inertia times acceleration.
  double residual() {
    executor_.derivative(signals_, rates_);
    double sum = 0;
    for (std::size_t e = 0; e < body_.size(); ++e) {
      const double* rate = &rates_[e * field_count];
      const Eigen::Vector3d dv(rate[vx], rate[vy], rate[vz]), dw(rate[wx], rate[wy], rate[wz]);
      const Vec3& inertia = body_[e]->inertia;
      Eigen::Vector3d moment = inertia[0] * dw;
      if (body_[e]->has_tensor_inertia()) {
        const double* f = &state_[e * field_count];
        const Eigen::Matrix3d axes =
            Eigen::Matrix3d::Identity() + reference::turn<double>({f[qs], {f[qx], f[qy], f[qz]}});
        moment =
            axes *
            Eigen::Vector3d(inertia[0], inertia[1], inertia[2]).cwiseProduct(axes.transpose() * dw);
      }
      sum += mass_ratio_[e] * mass_ratio_[e] *
             ((body_[e]->mass * dv).squaredNorm() + (moment / edge_).squaredNorm());
    }
    return load_norm_ > 0 ? std::sqrt(sum) / load_norm_ : std::sqrt(sum);
  }

  Executor& executor_;
  const Method& method_;
  double load_norm_;
  const RelaxationSettings& settings_;
  double edge_;
  std::vector<double> state_, rates_, signals_;
  std::vector<const Body*> body_;  ///< body of each element
  std::vector<double> mass_ratio_; ///< Problem::mass_ratio of each element
  long steps_between_ = 1;         ///< steps between checks of the kinetic energy
  Relaxation found_;
};

} // namespace

Problem relaxed_problem(const Problem& problem, bool has_scaled_masses, double loads) {
  Problem relaxed = held_still(problem, loads);
  relaxed.initial_motions.clear();
  const auto undamp = [](AxisConstants& axis) {
    axis.d_normal = 0;
    axis.d_shear = axis.d_rot = {};
  };
  for (Body& body : relaxed.bodies) {
    std::ranges::for_each(body.axis, undamp);
    for (auto& kind : body.more_kinds) std::ranges::for_each(kind, undamp);
  }
  for (ExtraLink& extra : relaxed.extra_links) undamp(extra.constants);
  relaxed.stabilization.d = relaxed.stabilization.d_rot = 0;
  if (has_scaled_masses) scale_masses(relaxed);
  return relaxed;
}

Relaxation relax(Executor& executor, const Problem& problem, const Method& method,
                 Precision precision, double load_norm, const RelaxationSettings& settings) {
  return KineticDamping(executor, problem, method, load_norm, settings)
      .run(is_single(precision) ? accepted_f32 : accepted_f64);
}

} // namespace dss
