#pragma once
/// The oracle: a plain solver of any problem by any method. Every variant is checked against it
/// (DESIGN.md sections 5 and 6). It shares no arithmetic with kernels/. Every operation has the
/// precision of T.
#include "solver/numerics/method.hpp"
#include "solver/numerics/step_control.hpp"
#include "solver/reference/dynamics.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

namespace dss {

namespace reference {
template <class T>
class ImplicitMidpoint;
}

/// Why and where a run stopped: the first state that is not finite, or a step whose equations had
/// no solution. In the second case the state is the one before the step.
struct Breakdown {
  long step = 0;           ///< counted from 0 at the call of advance
  std::size_t element = 0; ///< first such element, or the one with the largest residual
  std::string_view what = "the state is not finite";
};

/// Runs a problem in T (float, double or long double), from rest at t = 0 with all fields zero.
template <class T>
class Oracle {
public:
  /// Returns the signal values (one row of solver/numerics/signal_rows.hpp) at a stage of a step.
  /// Steps count from 0 at the call of advance. A leapfrog method also asks for stage 0 of the step
  /// after the last, to bring the velocities to the end of the run.
  using SignalSource = std::function<std::span<const double>(long step, int stage)>;

  /// `problem` must outlive the oracle; `dt` is the step [s].
  Oracle(const Problem& problem, const Method& method, double dt,
         Rotation rotation = Rotation::quaternion);
  ~Oracle();

  /// Sets the fields of elements from `first` on, 13 numbers each. Orientations are quaternions for
  /// every rotation. Restarts the method at t = 0.
  void write(std::span<const double> fields, std::size_t first = 0);
  /// Reads the fields of elements from `first` on, rounded to double.
  void read(std::span<double> fields, std::size_t first = 0) const;
  /// All fields of all elements in full precision. coordinates.hpp explains qs .. qz.
  const std::vector<T>& state() const { return state_; }

  /// Time derivative of every field at the present state. Uses the problem's signals at time t [s],
  /// or the given values.
  void derivative(double t, std::span<double> rates);
  void derivative(std::span<const double> signals, std::span<double> rates);

  /// Advances by `steps` steps, with the problem's own signals or with those of `signals`. Stops at
  /// the first step that leaves a non-finite state and returns where.
  std::optional<Breakdown> advance(long steps);
  std::optional<Breakdown> advance(long steps, const SignalSource& signals);

  /// Methods with an error stage: tries a step of dt [s], with one row of signals for each stage;
  /// accept_step keeps it.
  /// @return as Executor::try_step
  StepMaxima try_step(double dt, std::span<const double> signals);
  void accept_step();

  /// Kinetic, elastic and stabilization energy of the present state [J].
  T energy() { return dynamics_.energy(state_); }
  /// Number of steps since the start or the last write.
  long step_count() const { return step_count_; }
  double time() const { return double(step_count_) * dt_; }
  std::size_t bytes() const;

private:
  std::span<const double> signals_at(double t);
  std::optional<Breakdown> step_once(long step, const SignalSource& signals);
  /// y + h sum_j weights[row][j] k_j of field n.
  T moved(std::size_t row, std::size_t n, T h) const;
  /// Slopes of all stages of a step h [s]. signals_of(s) returns the signals of stage s.
  template <class Signals>
  void find_slopes(T h, const Signals& signals_of);
  void runge_kutta_step(long step, const SignalSource& signals);
  /// A step of an implicit method. @return the element of a Breakdown
  std::optional<std::size_t> implicit_step(long step, const SignalSource& signals);
  std::optional<std::size_t> diagonally_implicit_step(long step, const SignalSource& signals);
  std::optional<std::size_t> generalized_alpha_step(long step, const SignalSource& signals);
  void start_rate(std::span<const double> signals);
  void start_leapfrog(std::span<const double> signals);
  void leapfrog_step(long step, const SignalSource& signals);
  void finish_leapfrog(std::span<const double> signals);
  void reframe(std::vector<T>& state);
  std::optional<std::size_t> first_non_finite(const std::vector<T>& state) const;

  const Problem& problem_;
  Method method_;
  double dt_;
  reference::Dynamics<T> dynamics_;
  long step_count_ = 0;
  std::vector<T> state_; ///< y_n
  std::vector<double> signal_row_;
  /// Runge-Kutta: k_1, k_2, ...; diagonally implicit: k_0, ...; generalized alpha: the kept rate;
  /// leapfrog: the derivative.
  std::vector<std::vector<T>> slopes_;
  std::vector<T> trial_;     ///< state of a stage; leapfrog: (x_n, p_n)
  std::vector<T> half_step_; ///< leapfrog: velocities at n - 1/2, six an element
  bool is_leapfrog_started_ = false;
  std::unique_ptr<reference::ImplicitMidpoint<T>> implicit_; ///< only for implicit methods
  bool has_rate_ = false; ///< the first slope, or the rate, of the next step is known
  /// Butcher table: row s gives Y_s = y + h sum_j weights[s][j] k_j; the last row gives the step.
  std::vector<std::vector<T>> weights_;
};

} // namespace dss
