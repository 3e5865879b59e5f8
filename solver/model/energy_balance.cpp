#include "solver/model/energy_balance.hpp"

#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/rotation_vector.hpp"

#include <algorithm>
#include <cmath>

namespace dss {

using reference::Orientation;
using Vector = reference::Vector<double>;

namespace {

/// The energy at the end counts as at least this share of the largest during the run: motions may
/// end at rest.
constexpr double least_share = 0.1;
constexpr double resolved_share = 0.03;
/// Largest rotation from look to look [rad] for which the work of torques is right.
constexpr double most_turn = 1.5;
/// A harmonic signal needs looks at this part of its period.
constexpr double period_part = 0.25;

Orientation<double> conjugate(const Orientation<double>& q) { return {q.s, -q.v}; }

double simpson(double first, double middle, double last, double h) {
  return h / 6 * (first + 4 * middle + last);
}

} // namespace

EnergyBalance::EnergyBalance(const Problem& problem, Rotation rotation,
                             std::span<const double> state, double time, bool follows_dampers)
    : problem_(problem), dynamics_(energy_terms(problem, rotation)),
      follows_dampers_(follows_dampers), is_damped_(has_dampers(problem)),
      state_(placed(dynamics_, state)), time_(time),
      supplied_power_(dynamics_.supplied_power(state_, signals_at(problem, time))),
      start_(dynamics_.energy(state_)), largest_(start_), energy_(start_) {
  if (!is_damped_ || !follows_dampers_) return;
  dissipated_power_ = dynamics_.dissipated_power(state_);
  kinetic_ = dynamics_.kinetic_energy(state_);
}

std::vector<double> EnergyBalance::unseen_signals(double h) const {
  const auto unseen = [&](const Signal& signal) {
    if (signal.kind == Signal::Kind::constant) return 0.0;
    if (signal.kind == Signal::Kind::harmonic && std::abs(signal.frequency) * h > period_part)
      return 2 * std::abs(signal.amplitude);
    const double first = signal(time_), middle = signal(time_ + h / 2), last = signal(time_ + h);
    double largest = 0;
    const auto compare = [&](double t) {
      const double x = 2 * (t - time_) / h - 1; // -1 .. 1
      if (std::abs(x) >= 1) return;
      const double parabola =
          middle + x * (last - first) / 2 + x * x * ((first + last) / 2 - middle);
      largest = std::max(largest, std::abs(signal(t) - parabola));
    };
    for (const double part : {0.25, 0.75}) compare(time_ + part * h);
    if (signal.kind == Signal::Kind::ramp) compare(signal.duration);
    std::ranges::for_each(signal.times, compare);
    return largest;
  };
  std::vector<double> values;
  for (const Signal& signal : problem_.frame_acceleration) values.push_back(unseen(signal));
  for (const Load& load : problem_.loads) values.push_back(unseen(load.signal));
  values.resize(signal_count(problem_)); // a frame that rotates: frame_turns_unseen
  return values;
}

bool EnergyBalance::frame_turns_unseen(double h) const {
  if (!problem_.has_rotating_frame()) return false;
  std::array<std::vector<double>, 5> rows; // at equal distances over h
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = signals_at(problem_, time_ + double(k) * h / 4);
  double largest = 0, unseen = 0, turn = 0;
  for (std::size_t n = 3 + problem_.loads.size(); n < rows[0].size(); ++n) {
    for (const auto& row : rows) largest = std::max(largest, std::abs(row[n]));
    // against the parabola through the ends and the middle
    unseen =
        std::max(unseen, std::abs(rows[1][n] - (3 * rows[0][n] + 6 * rows[2][n] - rows[4][n]) / 8));
    unseen =
        std::max(unseen, std::abs(rows[3][n] - (3 * rows[4][n] + 6 * rows[2][n] - rows[0][n]) / 8));
    if (n < 6 + problem_.loads.size()) turn = std::max(turn, h * std::abs(rows[2][n]));
  }
  return unseen > resolved_share * largest || turn > period_part;
}

Vector EnergyBalance::turn_between(const Orientation<double>& q,
                                   const Orientation<double>& r) const {
  return dynamics_.coordinates().has_vectors()
             ? Vector(r.v - q.v)
             : reference::vector_of_orientation(reference::product(r, conjugate(q)));
}

double EnergyBalance::unseen_work_of_torques(std::span<const double> next, double time) const {
  const auto speed = [](const double* fields) { return Vector(&fields[wx]).norm(); };
  double work = 0;
  for (const Load& load : problem_.loads) {
    const double torque = Vector(load.torque.data()).norm() * std::abs(load.signal(time));
    for (const std::size_t e : load.elements) {
      const double *a = &state_[e * field_count], *b = &next[e * field_count];
      const double turned = std::max(
          turn_between(reference::orientation_fields(a), reference::orientation_fields(b)).norm(),
          (time - time_) * std::max(speed(a), speed(b)));
      if (turned > most_turn) work += torque * turned;
    }
  }
  return work;
}

std::vector<double> EnergyBalance::middle(std::span<const double> next, double h) const {
  const bool are_vectors = dynamics_.coordinates().has_vectors();
  std::vector<double> middle(state_.size());
  for (std::size_t e = 0; e < dynamics_.element_count(); ++e) {
    const double *a = &state_[e * field_count], *b = &next[e * field_count];
    double* m = &middle[e * field_count];
    const Orientation<double> q = reference::orientation_fields(a),
                              r = reference::orientation_fields(b);
    const Vector turned = turn_between(q, r);
    for (int axis = 0; axis < 3; ++axis) {
      const auto of_middle = [&](double change, double before, double after) {
        return 1.5 * change / h - (before + after) / 4;
      };
      m[ux + axis] = (a[ux + axis] + b[ux + axis]) / 2 + h / 8 * (a[vx + axis] - b[vx + axis]);
      m[vx + axis] = of_middle(b[ux + axis] - a[ux + axis], a[vx + axis], b[vx + axis]);
      m[wx + axis] = of_middle(turned[axis], a[wx + axis], b[wx + axis]);
    }
    const Orientation<double> half{(q.s + r.s) / 2, (q.v + r.v) / 2};
    reference::set_orientation_fields(m, are_vectors ? half : reference::of_unit_length(half));
  }
  return middle;
}

void EnergyBalance::follow_dampers(std::span<const double> half, std::span<const double> next,
                                   double h, double work) {
  const double power = dynamics_.dissipated_power(next), kinetic = dynamics_.kinetic_energy(next);
  const double taken = simpson(dissipated_power_, dynamics_.dissipated_power(half), power, h);
  const double mean = simpson(kinetic_, dynamics_.kinetic_energy(half), kinetic, 1);
  const double energy = dynamics_.energy(next);
  if (mean > 0) error_ *= std::exp(-taken / (2 * mean));
  error_ += energy - energy_ - work + taken;
  error_ = std::min(error_, energy); // no more can be left of it
  dissipated_ += taken;
  dissipated_power_ = power, kinetic_ = kinetic, energy_ = energy;
}

void EnergyBalance::look(std::span<const double> state, double time) {
  const double h = time - time_;
  if (h <= 0) return;
  const std::vector<double> next = placed(dynamics_, state), half = middle(next, h);
  const double supplied = dynamics_.supplied_power(next, signals_at(problem_, time));
  const double of_middle = dynamics_.supplied_power(half, signals_at(problem_, time_ + h / 2));
  const double work = simpson(supplied_power_, of_middle, supplied, h);
  work_ += work;
  if (frame_turns_unseen(h))
    unresolved_ +=
        h * std::max({std::abs(supplied_power_), std::abs(of_middle), std::abs(supplied)});
  unresolved_ += h * std::abs(dynamics_.supplied_power(half, unseen_signals(h))) +
                 unseen_work_of_torques(next, time);
  if (is_damped_ && follows_dampers_) follow_dampers(half, next, h, work);
  supplied_power_ = supplied;
  state_ = next;
  time_ = time;
  largest_ = std::max(largest_, start_ + work_ - dissipated_);
}

EnergyShares EnergyBalance::shares() {
  EnergyShares shares{start_, dynamics_.energy(state_), work_, dissipated_};
  shares.is_complete = follows_dampers_ || !is_damped_;
  const double expected = start_ + work_ - dissipated_;
  const double error = is_damped_ && follows_dampers_ ? error_ : shares.end - expected;
  const double scale = std::max({shares.end, shares.end - error, least_share * largest_});
  shares.error = error == 0 ? 0 : error / scale;
  shares.is_resolved = unresolved_ <= resolved_share * scale;
  return shares;
}

} // namespace dss
