#pragma once
/// Balance of energy over a run: what it has at the end, against its start, the work of loads and
/// of the frame's acceleration, and what dampers took.
#include "solver/model/energy.hpp"

#include <span>
#include <vector>

namespace dss {

/// Shares of a balance [J], and its error.
struct EnergyShares {
  double start = 0, end = 0;
  double work = 0;       ///< of loads and of the frame's acceleration
  double dissipated = 0; ///< by dampers; 0 if it was not followed
  /// False if dampers took an unknown amount: `error` is then only an upper bound of what the run
  /// gained.
  bool is_complete = true;
  /// What the run gained without a source (or lost, negative), for example by numerical damping or
  /// growth, over the energy at the end, which counts as at least 0.1 times the largest energy of
  /// the run. What dampers have taken of it since does not count.
  double error = 0;
  /// The work is known to 3 % of that energy: between two looks, signals change little and torques
  /// turn elements little.
  bool is_resolved = true;
  /// The whole error [J], with what dampers have taken of it since.
  double gained() const { return end - start - work + dissipated; }
};

/// Follows the energy of a run from look to look. Between two looks at times t and t + h, it takes
/// Simpson's rule of the powers, with
///     v(t + h/2) = 3/2 (u(t + h) - u(t)) / h - (v(t) + v(t + h)) / 4
/// so the mean velocity is that of the displacements, and the work of a constant force is exact
/// over any h. Angular velocities are treated in the same way, with the vector of the rotation from
/// look to look. So the work of a torque is right for rotations up to 1.5 rad from look to look.
///
/// Dampers that take D while the mean kinetic energy is T leave exp(-D / (2 T)) of vibrations,
/// whose energy is 2 T in the mean, and of an earlier error of the energy. So the error after a
/// look is
///     error = error_before exp(-D / (2 T)) + (E - E_before - W + D)
class EnergyBalance {
public:
  /// @param problem  must outlive this object
  /// @param rotation description of rotations of the run
  /// @param state    at `time` [s], field_count numbers an element with quaternions
  /// @param follows_dampers  true: what dampers take is found at each look, which is right if looks
  ///     are a step apart; false: it is left out
  EnergyBalance(const Problem& problem, Rotation rotation, std::span<const double> state,
                double time, bool follows_dampers);

  void look(std::span<const double> state, double time);
  /// The shares up to the last look.
  EnergyShares shares();

private:
  /// Adds what dampers took over h [s] up to the state `next`, and the error of the energy.
  void follow_dampers(std::span<const double> half, std::span<const double> next, double h,
                      double work);
  std::vector<double> middle(std::span<const double> next, double h) const;
  /// Vector of the rotation from q to r [rad].
  reference::Vector<double> turn_between(const reference::Orientation<double>& q,
                                         const reference::Orientation<double>& r) const;
  /// What torques may have done up to the state `next` where elements turned too far to tell [J].
  /// A rotation that is too fast for looks shows in angular velocities alone.
  double unseen_work_of_torques(std::span<const double> next, double time) const;
  /// Largest difference of each signal over [time_, time_ + h] to the parabola through its values
  /// at both ends and in the middle.
  std::vector<double> unseen_signals(double h) const;
  /// Whether the frame turns so far over [time_, time_ + h], or in such a way, that looks do not
  /// tell its work.
  bool frame_turns_unseen(double h) const;

  const Problem& problem_;
  reference::Dynamics<double> dynamics_;
  bool follows_dampers_, is_damped_;
  std::vector<double> state_; ///< at the last look, in the coordinates of dynamics_
  double time_, supplied_power_ = 0, dissipated_power_ = 0, kinetic_ = 0; ///< at the last look
  double start_, work_ = 0, dissipated_ = 0;
  double largest_;            ///< of what the run should have had at the looks
  double energy_, error_ = 0; ///< at the last look, if dampers are followed
  double unresolved_ = 0;     ///< part of the work that depends on how signals run between looks
};

} // namespace dss
