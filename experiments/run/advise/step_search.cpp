#include "experiments/run/advise/step_search.hpp"

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

/// the search ends if the passing number of steps is within this factor of a failing one
constexpr double fine_enough = 1.07;
constexpr double margin = 1.03;    ///< safety factor on the predicted number of steps
constexpr double longest_leap = 4; ///< largest factor from a failing number of steps to the next
/// errors stall if this factor of steps leaves more than this share of the error
constexpr double stalls_from = 1.5, stalls = 0.8;
constexpr int most_runs = 14;

/// Numbers of steps are multiples of this unit. Loads often have kinks at halves, quarters or
/// thirds of the time between saved times. Steps then end at the kinks; otherwise the error would
/// jump from one number of steps to the next.
long unit_of(long steps) { return steps < 8 ? 1 : steps < 40 ? 2 : steps < 160 ? 4 : 12; }
long rounded_up(long steps) {
  const long unit = unit_of(steps);
  return (steps + unit - 1) / unit * unit;
}

class StepSearch {
public:
  explicit StepSearch(const StepTask& task)
      : task_(task), order_(task.order), failing_(task.first - 1) {}

  StepResult result() {
    for (long steps = task_.first; result_.runs < most_runs; steps = next()) {
      if (task_.cost(steps) > task_.most_cost) break;
      if (try_steps(steps) || !is_open()) break;
    }
    if (result_.verdict != StepResult::Verdict::stalls && passing_ > 0)
      result_ = {StepResult::Verdict::meets, passing_, passing_error_, result_.runs};
    return result_;
  }

private:
  /// @return true if the search ends because errors stall
  bool try_steps(long steps) {
    const double error = task_.error(steps);
    ++result_.runs;
    result_.steps = steps;
    result_.error = error;
    if (error <= task_.most_error) {
      passing_ = steps;
      passing_error_ = error;
      return false;
    }
    if (std::isfinite(failing_error_) && failing_error_ > 0) {
      const double finer = double(steps) / double(failing_);
      if (passing_ == 0 && finer >= stalls_from && error > stalls * failing_error_) {
        result_.verdict = StepResult::Verdict::stalls;
        return true;
      }
      if (finer > 1.1) {
        order_ =
            std::clamp(std::log(failing_error_ / error) / std::log(finer), 0.5, 2.0 * task_.order);
        knows_order_ = true;
      }
    }
    failing_ = steps;
    failing_error_ = error;
    return false;
  }

  bool is_open() const {
    return passing_ == 0 || (passing_ > failing_ + unit_of(passing_) &&
                             double(passing_) > fine_enough * double(failing_));
  }

  long next() const {
    const double few = double(failing_);
    if (passing_ > 0) { // between a failing and a passing number
      double guess = std::sqrt(few * double(passing_));
      if (std::isfinite(failing_error_) && failing_error_ > 0) {
        const double predicted =
            few * std::pow(failing_error_ / task_.most_error, 1 / order_) * margin;
        if (predicted < 0.98 * double(passing_)) guess = predicted;
      }
      return std::clamp(rounded_up(long(std::ceil(guess))), failing_ + 1,
                        passing_ - unit_of(passing_));
    }
    if (!std::isfinite(failing_error_)) return rounded_up(2 * failing_);
    const double predicted = few * std::pow(failing_error_ / task_.most_error, 1 / order_) * margin;
    // Near the stability limit, errors may fall faster than the order says. One more run is made
    // before an expensive prediction is believed.
    const bool is_dear = task_.cost(long(std::min(predicted, 1e15))) > task_.most_cost;
    const double steps = is_dear && !knows_order_ ? 2 * few
                         : is_dear                ? predicted
                                                  : std::min(predicted, longest_leap * few);
    return rounded_up(std::max(failing_ + 1, long(std::ceil(std::min(steps, 1e15)))));
  }

  const StepTask& task_;
  double order_;
  long failing_, passing_ = 0;
  double failing_error_ = 0, passing_error_ = 0;
  bool knows_order_ = false;
  StepResult result_;
};

} // namespace

StepResult fewest_steps(const StepTask& task) { return StepSearch(task).result(); }

} // namespace dss
