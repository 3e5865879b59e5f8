#include "solver/numerics/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {
namespace {

constexpr double order_of_error = 5; ///< of dopri5: the estimate is that of the fourth-order result
constexpr double safety = 0.9, least_factor = 0.2, most_factor = 5;
constexpr double least_error = 1e-4; ///< a smaller error does not lengthen the next step further
/// Displacements belong to rotations, velocities to spins. A kind that is small beside its partner
/// may be zero except for rounding, and must not demand a step of zero. So its scale is at least
/// this share of the partner's.
constexpr double least_share = 1e-3;

} // namespace

void StepMaxima::add(const StepMaxima& other) {
  for (std::size_t k = 0; k < kinds; ++k) {
    error[k] = std::max(error[k], other.error[k]);
    state[k] = std::max(state[k], other.state[k]);
  }
  is_finite &= other.is_finite;
}

void StepControl::meet(std::span<const double> fields) {
  for (std::size_t n = 0; n < fields.size(); ++n) {
    double& largest = largest_[StepMaxima::kind(int(n % field_count))];
    largest = std::max(largest, std::abs(fields[n]));
  }
}

double StepControl::step_within(double left) const {
  return dt_ >= left ? left : std::min(dt_, 0.5 * left);
}

double StepControl::error_of(const StepMaxima& maxima,
                             const std::array<double, StepMaxima::kinds>& largest) const {
  if (!maxima.is_finite) return std::numeric_limits<double>::infinity();
  double error = 0;
  for (std::size_t k = 0; k < StepMaxima::kinds; ++k) {
    if (maxima.error[k] == 0) continue;
    const double partner =
        k < 2 ? largest[k + 2] * edge_ : largest[k - 2] / edge_; // u and q, v and w
    const double scale = std::max(largest[k], least_share * partner);
    error = std::max(error, maxima.error[k] / (tolerance_.atol + tolerance_.rtol * scale));
  }
  return error;
}

bool StepControl::accept(const StepMaxima& maxima, double tried) {
  std::array<double, StepMaxima::kinds> largest = largest_;
  for (std::size_t k = 0; k < StepMaxima::kinds; ++k)
    largest[k] = std::max(largest[k], maxima.state[k]);
  error_ = error_of(maxima, largest);
  if (!(error_ <= 1)) {
    dt_ = tried * std::max(least_factor, safety * std::pow(error_, -1 / order_of_error));
    was_rejected_ = true;
    return false;
  }
  largest_ = largest;
  const double error = std::max(error_, least_error);
  const double factor = safety * std::pow(error, -0.7 / order_of_error) *
                        std::pow(error_before_, 0.4 / order_of_error);
  const double next = tried * std::clamp(factor, least_factor, was_rejected_ ? 1 : most_factor);
  // A step cut short for an output says less about the next step than the step before it did.
  const bool was_cut = tried < dt_;
  dt_ = was_cut ? std::max(dt_, next) : next;
  if (!was_cut) error_before_ = error;
  was_rejected_ = false;
  return true;
}

} // namespace dss
