#pragma once
/// How long the next step is, from the error that a tried step estimates (methods with an error stage, method.hpp).
#include "solver/model/fields.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace dss {

/// Largest magnitudes over all elements after a tried step, for each kind of field: u [m], v [m/s], q, w [rad/s]. No order and no
/// partition of the elements changes a maximum, so all variants take the same steps.
struct StepMaxima {
  static constexpr std::size_t kinds = 4;
  std::array<double, kinds> error{}; ///< of the estimated error
  std::array<double, kinds> state{}; ///< of the state that the step leads to
  bool is_finite = true;             ///< all of both is

  void add(const StepMaxima& other);
  static constexpr std::size_t kind(int field) { return field < vx ? 0 : field < qs ? 1 : field < wx ? 2 : 3; }
};

struct StepTolerance {
  double rtol = 0; ///< relative to the largest number of a kind that the run has met
  double atol = 0; ///< in the unit of the kind
};

/// PI control (Hairer, Norsett, Wanner II, section IV.2; K. Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533-554): after a step h of
/// error err, in units of what is tolerated, and one of err_before, the next is
///     h * 0.9 * err^(-0.7/5) * err_before^(0.4/5),
/// at least 0.2 h, at most 5 h, and at most h right after a rejection. A step with err > 1 is rejected, and tried again with
/// h * 0.9 * err^(-1/5), at least 0.2 h: what is not finite has an infinite error.
class StepControl {
public:
  /// @param edge  shortest edge of an element [m]  @param dt  the first step that is tried [s]
  StepControl(const StepTolerance& tolerance, double edge, double dt) : tolerance_(tolerance), edge_(edge), dt_(dt) {}

  /// The state that the run begins with, or part of it: 13 numbers an element.
  void meet(std::span<const double> fields);
  /// The step to try [s] if so much time is left until somebody looks: no longer than that, and it leaves no small rest.
  double step_within(double left) const;
  /// Judges a tried step of `tried` [s] and sets the next one. @return whether it is accepted
  bool accept(const StepMaxima& maxima, double tried);
  /// The step that the control would have next [s].
  double dt() const { return dt_; }
  /// Of the step that was judged last, in units of what is tolerated.
  double error() const { return error_; }

private:
  double error_of(const StepMaxima& maxima, const std::array<double, StepMaxima::kinds>& largest) const;

  const StepTolerance tolerance_;
  const double edge_;
  double dt_, error_ = 0, error_before_ = 1;
  bool was_rejected_ = false;
  std::array<double, StepMaxima::kinds> largest_{}; ///< met so far
};

} // namespace dss
