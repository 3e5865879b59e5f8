#include "experiments/run/stability/stability_limit.hpp"
#include "experiments/run/state/random_state.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Size of the initial displacements [edges] and rotations [rad]: their squares are far below
/// rounding.
constexpr double tiny = 1e-100;
/// Size at which a run stops. It is still tiny, so that nonlinear effects cannot stop slow growth.
constexpr double blow_up = 1e-60;
constexpr double seen_above = 1.002; ///< growth must be visible at this multiple of the prediction
constexpr double several = 2.5; ///< a drifting rigid body is only twice as far in its second half
constexpr long least_steps = 100, usual_steps = 10'000, most_steps = 1'000'000;
constexpr long looks = 32; ///< checks of the state in each run

/// Units of a random state, chosen so that no mode starts far below the others.
struct MotionScale {
  double edge, omega;
};

MotionScale scale_of(const Problem& problem, double omega) {
  return {shortest_edge(problem), omega > 0 ? omega : 1};
}

std::vector<double> tiny_state(const Problem& problem, const MotionScale& scale) {
  std::vector<double> state = random_state(problem, Model::spatial, Precision::f64, 20220617);
  for (std::size_t at = 0; at < state.size(); at += field_count) {
    double* const y = &state[at];
    for (int axis = 0; axis < 3; ++axis) {
      y[ux + axis] *= 100 * tiny; // random_state has hundredths of an edge
      y[qx + axis] *= tiny;
      y[vx + axis] *= tiny * scale.edge * scale.omega;
      y[wx + axis] *= 0.1 * tiny * scale.omega; // random_state has 10 rad/s
    }
    y[qs] = 0; // of the order of a square
  }
  return state;
}

/// Largest field in the units of `scale`; infinite if a field is not finite.
double amplitude(const std::vector<double>& state, const MotionScale& scale) {
  const std::array<double, 4> units = {scale.edge, scale.edge * scale.omega, 1,
                                       scale.omega}; // u v q w
  double most = 0;
  for (std::size_t n = 0; n < state.size(); ++n) {
    const std::size_t field = n % field_count;
    const double own = std::abs(state[n]) / units[field < vx   ? 0
                                                  : field < qs ? 1
                                                  : field < wx ? 2
                                                               : 3];
    if (!std::isfinite(own)) return infinite;
    most = std::max(most, own);
  }
  return most;
}

/// Searches the step at which runs begin to grow.
class LimitSearch {
public:
  LimitSearch(const Plugin& plugin, const Problem& problem, const Method& method,
              const StabilityLimit& predicted, double element_steps)
      : plugin_(plugin), problem_(problem), method_(method),
        scale_(scale_of(problem, predicted.omega_max)), start_(tiny_state(problem, scale_)),
        signal_width_(signal_count(problem)) {
    steps_ = steps_to_see(predicted, element_steps);
    no_signals_.assign(
        (std::size_t(steps_ / looks) * std::size_t(method.stages) + 1) * signal_width_, 0.0);
  }

  /// @param is_near  true: the limit is expected at the guess, so the search first tests steps
  /// close to it, then further away, and bisects last
  LimitMeasurement around(double guess, bool is_near) {
    double bounded = 0.8 * guess, growing = 1.25 * guess;
    for (int n = 0; !is_bounded(bounded); ++n) {
      if (n == most_tries) return {0, bounded, steps_, runs_};
      growing = std::exchange(bounded, bounded / 2);
    }
    for (int n = 0; is_bounded(growing); ++n) {
      if (n == most_tries) return {growing, infinite, steps_, runs_};
      bounded = std::exchange(growing, 1.5 * growing);
    }
    start_from_what_grew();
    const auto narrow = [&](double dt) {
      if (bounded < dt && dt < growing) (is_bounded(dt) ? bounded : growing) = dt;
    };
    for (double distance = nearest; is_near && distance < 0.2; distance *= further) {
      narrow((1 - distance) * guess);
      narrow((1 + distance) * guess);
    }
    while (growing > (1 + limit_resolution) * bounded) narrow((bounded + growing) / 2);
    return {bounded, growing, steps_, runs_};
  }

private:
  static constexpr int most_tries = 3;
  /// distance of the first tests from the guess; one test on each side can be enough
  static constexpr double nearest = 0.4 * limit_resolution;
  static constexpr double further = 2.5; ///< factor between the distances of successive tests

  /// Steps of a run: enough for growth by e^16 at seen_above. If no growth is predicted there, the
  /// usual number.
  long steps_to_see(const StabilityLimit& predicted, double element_steps) const {
    const double growth = spectral_radius(method_, seen_above * predicted.dt, predicted.mode.omega,
                                          predicted.mode.rate) -
                          1;
    const double wanted = predicted.dt == 0 ? double(most_steps)
                          : growth > 0      ? 16 / growth
                                            : double(usual_steps);
    const double affordable = element_steps / double(problem_.lattice.element_count);
    const double steps =
        std::clamp(std::min(wanted, affordable), double(least_steps), double(most_steps));
    return looks * long(std::ceil(steps / double(looks)));
  }

  /// Adds the shape that grew above the limit to the random start, with ten times its size. Slow
  /// growth is then visible without first overtaking stable motions.
  void start_from_what_grew() {
    const double size = amplitude(grown_, scale_);
    if (!std::isfinite(size) || size == 0) return;
    const double share = 10 * amplitude(start_, scale_) / size;
    // zero to first order for a tiny rotation
    for (std::size_t n = 0; n < start_.size(); ++n)
      if (n % field_count != qs) start_[n] += share * grown_[n];
  }

  bool is_bounded(double dt) {
    ++runs_;
    const auto executor =
        make_executor(plugin_, {problem_, method_, Model::spatial, Precision::f64, dt});
    executor->write(0, start_);
    std::array<double, 2> most = {0, 0}; // of each half
    for (long look = 0; look < looks; ++look) {
      if (!executor->advance(steps_ / looks, no_signals_).is_finite) return false;
      const std::vector<double> state = whole_state(*executor, problem_.lattice.element_count);
      const double now = amplitude(state, scale_);
      if (!(now <= blow_up)) {
        grown_ = state;
        return false;
      }
      double& half = most[look < looks / 2 ? 0 : 1];
      half = std::max(half, now);
    }
    return most[1] <= several * most[0];
  }

  const Plugin& plugin_;
  const Problem& problem_;
  const Method& method_;
  MotionScale scale_;
  std::vector<double> start_, grown_, no_signals_;
  std::size_t signal_width_;
  long steps_ = 0;
  int runs_ = 0;
};

/// First step to test. If no limit is predicted, it is a step that the fastest mode would notice.
double guess_of(const StabilityLimit& predicted) {
  return predicted.dt > 0 ? predicted.dt : 1 / predicted.omega_max;
}

void judge(LimitComparison& row) {
  const double limit = row.predicted.dt, ratio = row.ratio();
  row.status = "ok";
  if (limit == 0) {
    row.reason = "grows however small the step";
    if (row.measured.dt == 0) return;
    // A mode is a small part of the random start: it is visible after growth by about e^10.
    const double growth =
        spectral_radius(*row.method, row.measured.dt, row.predicted.omega_max, 0) - 1;
    row.status = growth * double(row.measured.steps) < 10 ? "unresolved" : "failed";
    row.reason =
        fmt::format("should grow at every step, but is bounded at {:.4g} s", row.measured.dt);
    return;
  }
  if (ratio < 1 - limit_tolerance) {
    row.status = "failed";
    row.reason =
        fmt::format("runs grow at {:.4g} of the predicted limit", row.measured.growing_dt / limit);
  } else if (!row.predicted.is_exact) {
    row.status = "bound";
    row.reason = fmt::format(
        "runs are bounded at {:.4g} of what is predicted, which is on the safe side", ratio);
  } else if (row.predicted.is_exact && ratio > 1 + limit_tolerance) {
    const double growth = spectral_radius(*row.method, (1 + limit_tolerance) * limit,
                                          row.predicted.mode.omega, row.predicted.mode.rate) -
                          1;
    const bool is_slow =
        growth > 0 && growth * double(row.measured.steps) / 2 < std::log(several) + 1;
    row.status = is_slow ? "unresolved" : "failed";
    row.reason =
        is_slow ? fmt::format(
                      "{:.2g} % above the limit a step grows by {:.2g}, which {} steps do not show",
                      100 * limit_tolerance, growth, row.measured.steps)
                : fmt::format("runs are bounded at {:.4g} of the predicted limit, which is exact",
                              ratio);
  }
}

} // namespace

LimitMeasurement measure_limit(const Plugin& plugin, const Problem& problem, const Method& method,
                               const StabilityLimit& predicted, double element_steps) {
  const bool is_near = predicted.is_exact && predicted.dt > 0;
  return LimitSearch(plugin, problem, method, predicted, element_steps)
      .around(guess_of(predicted), is_near);
}

LimitComparison compare_limit(const Plugin& plugin, const Problem& problem, const Method& method,
                              const StabilityLimit& predicted, double element_steps) {
  if (!std::isfinite(predicted.dt))
    return predicted_alone(method, predicted,
                           method.is_unlimited() ? "implicit or exact: no step is too large"
                                                 : "nothing vibrates or is damped");
  LimitComparison row{
      &method, predicted, measure_limit(plugin, problem, method, predicted, element_steps), {}, {}};
  judge(row);
  return row;
}

LimitComparison predicted_alone(const Method& method, const StabilityLimit& predicted,
                                const std::string& why) {
  return {&method, predicted, {}, "not measured", why};
}

std::string mode_text(const StabilityLimit& limit) {
  const Mode& mode = limit.mode;
  const std::string shape = mode.omega > 0 ? fmt::format("{:.4g} rad/s, damping ratio {:.3g}",
                                                         mode.omega, mode.rate / (2 * mode.omega))
                                           : fmt::format("a decay of {:.4g} 1/s", mode.rate);
  return limit.is_exact ? fmt::format("{}, most in {} of element {}", shape,
                                      dof_names[std::size_t(mode.dof)], mode.element)
                        : shape + ", the worst that the bounds allow";
}

} // namespace dss
