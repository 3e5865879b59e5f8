#include "solver/reference/oracle.hpp"

#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/implicit_midpoint.hpp"
#include "solver/reference/real_types.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dss {
namespace {

/// Classical (Butcher) table of a Runge-Kutta method in increment form. It substitutes
/// Y_m - y = h sum_j w[m][j] k_j into Y_{s+1} - y = sum_m alpha[s][m] (Y_m - y) + h beta[s] k_s.
template <class T>
std::vector<std::vector<T>> butcher_rows(const Method& method) {
  const auto stages = std::size_t(method.stages);
  std::vector<std::vector<T>> w(stages + 1, std::vector<T>(stages, T(0)));
  for (std::size_t s = 0; s < stages; ++s) {
    for (std::size_t m = 1; m <= s; ++m)
      for (std::size_t j = 0; j < m; ++j) w[s + 1][j] += T(method.alpha[s][m]) * w[m][j];
    w[s + 1][s] += T(method.beta[s]);
  }
  return w;
}

template <class T>
reference::Orientation<double> rounded(const reference::Orientation<T>& q) {
  return {double(q.s), q.v.template cast<double>()};
}

} // namespace

template <class T>
Oracle<T>::Oracle(const Problem& problem, const Method& method, double dt, Rotation rotation)
    : problem_(problem), method_(method), dt_(dt), dynamics_(problem, rotation),
      state_(problem.lattice.element_count * field_count, T(0)), signal_row_(signal_count(problem)),
      slopes_(std::size_t(method.stages), std::vector<T>(state_.size())), trial_(state_.size()) {
  if (method.is_exponential) throw std::logic_error("the oracle has no exponential methods");
  if (method.family == Method::Family::runge_kutta) weights_ = butcher_rows<T>(method);
  if (method.is_in_place()) half_step_.resize(6 * problem.lattice.element_count);
  if (method.is_implicit())
    implicit_ =
        std::make_unique<reference::ImplicitMidpoint<T>>(problem, 2 * implicit_share(method) * dt);
}

template <class T>
Oracle<T>::~Oracle() = default;

template <class T>
void Oracle<T>::write(std::span<const double> fields, std::size_t first) {
  std::transform(fields.begin(), fields.end(), state_.begin() + std::ptrdiff_t(first * field_count),
                 [](double value) { return T(value); });
  for (std::size_t e = first; e < first + fields.size() / field_count; ++e) {
    T* f = &state_[e * field_count];
    reference::set_orientation_fields(
        f, dynamics_.coordinates().write(e, reference::orientation_fields(f)));
  }
  step_count_ = 0;
  is_leapfrog_started_ = has_rate_ = false;
  if (implicit_) implicit_->restart();
}

template <class T>
void Oracle<T>::read(std::span<double> fields, std::size_t first) const {
  std::transform(state_.begin() + std::ptrdiff_t(first * field_count),
                 state_.begin() + std::ptrdiff_t(first * field_count + fields.size()),
                 fields.begin(), [](T value) { return double(value); });
  for (std::size_t n = 0; n < fields.size(); n += field_count) {
    const std::size_t e = first + n / field_count;
    const auto q =
        dynamics_.coordinates().read(e, reference::orientation_fields(&state_[e * field_count]));
    reference::set_orientation_fields(&fields[n], rounded(q));
  }
}

template <class T>
std::span<const double> Oracle<T>::signals_at(double t) {
  signal_row_ = dss::signals_at(problem_, t);
  return signal_row_;
}

template <class T>
void Oracle<T>::derivative(double t, std::span<double> rates) {
  derivative(signals_at(t), rates);
}

template <class T>
void Oracle<T>::derivative(std::span<const double> signals, std::span<double> rates) {
  dynamics_.rates(state_, signals, slopes_[0]);
  std::transform(slopes_[0].begin(), slopes_[0].end(), rates.begin(),
                 [](T value) { return double(value); });
  for (std::size_t e = 0; e < dynamics_.element_count(); ++e) {
    const T* y = &state_[e * field_count];
    const auto dq = dynamics_.coordinates().read_rate(e, reference::orientation_fields(y),
                                                      {y[wx], y[wy], y[wz]});
    reference::set_orientation_fields(&rates[e * field_count], rounded(dq));
  }
}

template <class T>
std::optional<Breakdown> Oracle<T>::advance(long steps) {
  const long begin = step_count_;
  return advance(steps, [this, begin](long step, int stage) {
    return signals_at((double(begin + step) + method_.node[std::size_t(stage)]) * dt_);
  });
}

template <class T>
std::optional<Breakdown> Oracle<T>::advance(long steps, const SignalSource& signals) {
  for (long step = 0; step < steps; ++step)
    if (const auto breakdown = step_once(step, signals)) return breakdown;
  if (method_.is_staggered() && steps > 0) finish_leapfrog(signals(steps, 0));
  if (method_.is_in_place() && !method_.is_staggered() && steps > 0) state_ = trial_;
  return std::nullopt;
}

template <class T>
std::optional<Breakdown> Oracle<T>::step_once(long step, const SignalSource& signals) {
  if (method_.family == Method::Family::runge_kutta) runge_kutta_step(step, signals);
  if (method_.is_in_place()) leapfrog_step(step, signals);
  if (implicit_)
    if (const auto element = implicit_step(step, signals))
      return Breakdown{step, *element, "Newton's iteration finds no state"};
  ++step_count_;
  std::vector<T>& reached = method_.is_in_place() ? trial_ : state_;
  if (const auto element = first_non_finite(reached)) {
    state_ = reached;
    return Breakdown{step, *element};
  }
  reframe(reached);
  return std::nullopt;
}

template <class T>
T Oracle<T>::moved(std::size_t row, std::size_t n, T h) const {
  T slope = 0;
  for (std::size_t j = 0; j < row; ++j) slope += weights_[row][j] * slopes_[j][n];
  return state_[n] + h * slope;
}

template <class T>
template <class Signals>
void Oracle<T>::find_slopes(T h, const Signals& signals_of) {
  dynamics_.rates(state_, signals_of(0), slopes_[0]);
  for (std::size_t s = 1; s < slopes_.size(); ++s) {
    for (std::size_t n = 0; n < state_.size(); ++n) trial_[n] = moved(s, n, h);
    dynamics_.rates(trial_, signals_of(s), slopes_[s]);
  }
}

template <class T>
void Oracle<T>::runge_kutta_step(long step, const SignalSource& signals) {
  const T h = T(dt_);
  find_slopes(h, [&](std::size_t stage) { return signals(step, int(stage)); });
  for (std::size_t n = 0; n < state_.size(); ++n) state_[n] = moved(slopes_.size(), n, h);
}

template <class T>
std::optional<std::size_t> Oracle<T>::implicit_step(long step, const SignalSource& signals) {
  switch (method_.family) {
  case Method::Family::diagonally_implicit:
    return diagonally_implicit_step(step, signals);
  case Method::Family::generalized_alpha:
    return generalized_alpha_step(step, signals);
  default:
    return implicit_->step(dynamics_, state_, signals(step, 0));
  }
}

/// Makes the last slope that of the present state, unless the last step did so.
template <class T>
void Oracle<T>::start_rate(std::span<const double> signals) {
  if (!has_rate_) dynamics_.rates(state_, signals, slopes_.back());
  has_rate_ = true;
}

template <class T>
std::optional<std::size_t> Oracle<T>::diagonally_implicit_step(long step,
                                                               const SignalSource& signals) {
  const T h = T(dt_);
  const bool is_first_explicit = method_.beta[0] == 0;
  if (is_first_explicit) {
    start_rate(signals(step, 0));
    slopes_[0] = slopes_.back();
  }
  std::vector<T> reached(state_.size());
  for (std::size_t s = is_first_explicit ? 1 : 0; s < slopes_.size(); ++s) {
    for (std::size_t n = 0; n < state_.size(); ++n) {
      T slope = 0;
      for (std::size_t m = 0; m < s; ++m) slope += T(method_.alpha[s][m]) * slopes_[m][n];
      trial_[n] = state_[n] + h * slope;
    }
    if (const auto element =
            implicit_->stage(dynamics_, trial_, signals(step, int(s)), reached, slopes_[s])) {
      has_rate_ = false;
      return element;
    }
  }
  state_ = reached;
  return std::nullopt;
}

/// The stage Y = y_n + node (y_{n+1} - y_n) with the new rate eliminated.
template <class T>
std::optional<std::size_t> Oracle<T>::generalized_alpha_step(long step,
                                                             const SignalSource& signals) {
  const T h = T(dt_), node = T(method_.node[1]), a = T(method_.rate_share),
          g = T(method_.rate_weight());
  start_rate(signals(step, 0));
  std::vector<T>& rate = slopes_.back();
  for (std::size_t n = 0; n < state_.size(); ++n)
    trial_[n] = state_[n] + node * h * (T(1) - g - g * (T(1) - a) / a) * rate[n];
  std::vector<T> reached(state_.size()), slope(state_.size());
  if (const auto element = implicit_->stage(dynamics_, trial_, signals(step, 1), reached, slope)) {
    has_rate_ = false;
    return element;
  }
  for (std::size_t n = 0; n < state_.size(); ++n) {
    const T next = (slope[n] - (T(1) - a) * rate[n]) / a;
    state_[n] += h * ((T(1) - g) * rate[n] + g * next);
    rate[n] = next;
  }
  return std::nullopt;
}

template <class T>
StepMaxima Oracle<T>::try_step(double dt, std::span<const double> signals) {
  const std::size_t stages = slopes_.size(), width = signals.size() / stages;
  const T h = T(dt);
  find_slopes(h, [&](std::size_t stage) { return signals.subspan(stage * width, width); });
  StepMaxima maxima;
  for (std::size_t n = 0; n < state_.size(); ++n) {
    T error = 0;
    for (std::size_t j = 0; j < stages; ++j) error += weights_[stages][j] * slopes_[j][n];
    const std::size_t kind = StepMaxima::kind(int(n % field_count));
    const double size = double(std::abs(h * error)), reached = double(std::abs(trial_[n]));
    maxima.error[kind] = std::max(maxima.error[kind], size);
    maxima.state[kind] = std::max(maxima.state[kind], reached);
    maxima.is_finite &= std::isfinite(size) && std::isfinite(reached);
  }
  return maxima;
}

template <class T>
void Oracle<T>::accept_step() {
  state_ = trial_;
  ++step_count_;
  reframe(state_);
}

/// v_{-1/2} = v_0 - (h/2) a_0 and p_0 = v_0; symplectic Euler keeps v_0. Stores a_0 in slopes_[0].
template <class T>
void Oracle<T>::start_leapfrog(std::span<const double> signals) {
  trial_ = state_;
  dynamics_.rates(trial_, signals, slopes_[0]);
  const T half_dt = method_.is_staggered() ? T(dt_) / T(2) : T(0);
  for (std::size_t e = 0; e < dynamics_.element_count(); ++e) {
    const T *y = &trial_[e * field_count], *a = &slopes_[0][e * field_count];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      half_step_[6 * e + axis] = y[vx + axis] - half_dt * a[vx + axis];
      half_step_[6 * e + 3 + axis] = y[wx + axis] - half_dt * a[wx + axis];
    }
  }
  is_leapfrog_started_ = true;
}

template <class T>
void Oracle<T>::leapfrog_step(long step, const SignalSource& signals) {
  if (is_leapfrog_started_)
    dynamics_.rates(trial_, signals(step, 0), slopes_[0]);
  else
    start_leapfrog(signals(step, 0));
  const T h = T(dt_), smoothing = T(method_.smoothing),
          ahead = method_.is_staggered() ? (1 - smoothing) / 2 * h : T(0);
  for (std::size_t e = 0; e < dynamics_.element_count(); ++e) {
    T *y = &trial_[e * field_count], *half = &half_step_[6 * e];
    const T* a = &slopes_[0][e * field_count];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T correction = y[vx + axis] - half[axis],
              turn_correction = y[wx + axis] - half[3 + axis];
      half[axis] += h * a[vx + axis];
      half[3 + axis] += h * a[wx + axis];
      y[ux + axis] += h * half[axis];
      y[vx + axis] = half[axis] + smoothing * correction + ahead * a[vx + axis];
      y[wx + axis] = half[3 + axis] + smoothing * turn_correction + ahead * a[wx + axis];
    }
    const reference::Vector<T> w = {half[3], half[4], half[5]};
    const auto& coordinates = dynamics_.coordinates();
    reference::set_orientation_fields(y, coordinates.moved(reference::orientation_fields(y), w, h));
  }
}

/// The state that callers read: positions as they are, velocities v_n = v_{n-1/2} + (h/2) a(x_n,
/// p_n). The run itself continues from p_n.
template <class T>
void Oracle<T>::finish_leapfrog(std::span<const double> signals) {
  dynamics_.rates(trial_, signals, slopes_[0]);
  state_ = trial_;
  const T half_dt = T(dt_) / T(2);
  for (std::size_t e = 0; e < dynamics_.element_count(); ++e) {
    T* y = &state_[e * field_count];
    const T* a = &slopes_[0][e * field_count];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      y[vx + axis] = half_step_[6 * e + axis] + half_dt * a[vx + axis];
      y[wx + axis] = half_step_[6 * e + 3 + axis] + half_dt * a[wx + axis];
    }
  }
}

/// Restarts coordinates that are near their singularity. Only between steps, because the stages of
/// a step share the bases. A rate that the method keeps differs from that of the state by O(h). The
/// difference is carried over to the new coordinates.
template <class T>
void Oracle<T>::reframe(std::vector<T>& state) {
  auto& coordinates = dynamics_.coordinates();
  if (!coordinates.has_bases()) return;
  for (std::size_t e = 0; e < dynamics_.element_count(); ++e) {
    T* y = &state[e * field_count];
    auto c = reference::orientation_fields(y);
    const reference::Vector<T> w = {y[wx], y[wy], y[wz]}, before = coordinates.rate(c, w).v;
    coordinates.reframe(e, c);
    reference::set_orientation_fields(y, c);
    if (!has_rate_) continue;
    T* kept = &slopes_.back()[e * field_count];
    auto rate = reference::orientation_fields(kept);
    rate.v += coordinates.rate(c, w).v - before;
    reference::set_orientation_fields(kept, rate);
  }
}

template <class T>
std::optional<std::size_t> Oracle<T>::first_non_finite(const std::vector<T>& state) const {
  const auto bad =
      std::find_if(state.begin(), state.end(), [](T value) { return !std::isfinite(value); });
  if (bad == state.end()) return std::nullopt;
  return std::size_t(bad - state.begin()) / field_count;
}

template <class T>
std::size_t Oracle<T>::bytes() const {
  return dynamics_.bytes() +
         (state_.size() * (2 + slopes_.size()) + half_step_.size()) * sizeof(T) +
         (implicit_ ? implicit_->bytes() : 0);
}

#define DSS_INSTANTIATE(T) template class Oracle<T>;
DSS_EACH_REAL(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
