#pragma once
/// Length of the next step, from the error that a tried step estimates (methods with an error
/// stage, method.hpp).
#include "kernels/fields.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace dss {

/// Largest magnitudes over all elements after a tried step, for each kind of field: u [m], v [m/s],
/// q, w [rad/s]. A maximum does not depend on the order or partition of the elements, so all
/// variants take the same steps.
struct StepMaxima {
  static constexpr std::size_t kinds = 4;
  std::array<double, kinds> error{}; ///< of the estimated error
  std::array<double, kinds> state{}; ///< of the state at the end of the step
  bool is_finite = true;             ///< true if all errors and states are finite

  void add(const StepMaxima& other);
  static constexpr std::size_t kind(int field) {
    return field < vx ? 0 : field < qs ? 1 : field < wx ? 2 : 3;
  }
};

/// Tolerance for the error of a step: rtol times the largest number of a kind, plus atol.
struct StepTolerance {
  double rtol = 0; ///< relative to the largest number of the kind in the run so far
  double atol = 0; ///< absolute, in the unit of the kind
};

/// PI control (Hairer, Norsett, Wanner II, section IV.2; K. Gustafsson, ACM Trans. Math. Softw. 17
/// (1991) 533-554). err is the error over the tolerance of the last step h, err_before the one of
/// the step before. The next step is
///     h * 0.9 * err^(-0.7/5) * err_before^(0.4/5)
/// at least 0.2 h, at most 5 h, and at most h directly after a rejection. A step with err > 1 is
/// rejected and tried again with h * 0.9 * err^(-1/5), at least 0.2 h. A state that is not finite
/// has an infinite error.
class StepControl {
public:
  /// @param edge  shortest edge of an element [m]
  /// @param dt    first step to try [s]
  StepControl(const StepTolerance& tolerance, double edge, double dt)
      : tolerance_(tolerance), edge_(edge), dt_(dt) {}

  /// Takes in the initial state or part of it: 13 numbers an element.
  void meet(std::span<const double> fields);
  /// The step to try [s] if `left` [s] remain until the next output. It is not longer than that and
  /// leaves no small rest.
  double step_within(double left) const;
  /// Judges a tried step of `tried` [s] and sets the next one.
  /// @return true if the step is accepted
  bool accept(const StepMaxima& maxima, double tried);
  /// Step that the control proposes next [s].
  double dt() const { return dt_; }
  /// Error over tolerance of the last judged step.
  double error() const { return error_; }
  /// Visits what a continued run needs (solver/io/kept_numbers.hpp).
  template <class Visit>
  void each_kept(Visit&& visit) {
    visit(dt_), visit(error_), visit(error_before_), visit(was_rejected_), visit(largest_);
  }

private:
  double error_of(const StepMaxima& maxima,
                  const std::array<double, StepMaxima::kinds>& largest) const;

  const StepTolerance tolerance_;
  const double edge_;
  double dt_, error_ = 0, error_before_ = 1;
  bool was_rejected_ = false;
  std::array<double, StepMaxima::kinds> largest_{}; ///< in the run so far
};

} // namespace dss
