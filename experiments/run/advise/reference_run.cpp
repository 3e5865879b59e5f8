#include "experiments/run/advise/reference_run.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

/// smallest ratio of successive changes that is believed
constexpr double least_shrinking = 1.0 / 8;
/// A change counts as shrinking if it is below 0.7 of the previous one.
constexpr double shrinks = 0.7;
/// Changes that stop shrinking above this size are not caused by f64 rounding.
constexpr double of_rounding = 1e-7;

/// Halves the step until the goal is met or cannot be met.
class Halving {
public:
  Halving(const Workbench& bench, Configuration start, double tolerance, double budget_s)
      : bench_(bench), next_(std::move(start)), tolerance_(tolerance), budget_s_(budget_s) {}

  ReferenceRun result() {
    while (step()) next_.steps_between *= 2;
    return std::move(reference_);
  }

private:
  /// Runs one more level. @return true if another is needed
  bool step() {
    if (const double next_s = predicted_s(); !is_first() && next_s > budget_s_)
      return give_up_for_time(next_s);
    Observation observation = bench_.run(next_);
    budget_s_ -= observation.wall_s;
    if (!observation.failure.empty()) {
      // large motions may need shorter steps than small ones
      if (is_first() && ++tries_ < 4) return true;
      reference_.failure = fmt::format("a run with steps of {:.3g} s fails: {}", bench_.dt(next_),
                                       observation.failure);
      return false;
    }
    const bool was_first = is_first();
    if (!was_first) judge(observation.observed);
    reference_.configuration = next_;
    reference_.observed = std::move(observation.observed);
    reference_.levels.push_back({next_.steps_between, 0, observation.wall_s});
    if (was_first) return true;
    return reference_.error > reference_goal * tolerance_ && !has_stalled();
  }

  bool is_first() const { return reference_.levels.empty(); }
  double predicted_s() const { return is_first() ? 0 : 2 * reference_.levels.back().wall_s; }

  void judge(const Observed& finer) {
    const double before =
        reference_.levels.size() > 1 ? reference_.levels[reference_.levels.size() - 2].change : 0;
    const double change = bench_.error(finer, reference_.observed);
    reference_.levels.back().change = change;
    const double ratio = before > 0 ? change / before : 0.5; // the order is not known yet
    stalls_ = before > 0 && ratio > shrinks ? stalls_ + 1 : 0;
    const double believed = std::clamp(ratio, least_shrinking, shrinks);
    reference_.error = stalls_ > 0 ? std::max(change, before) : change * believed / (1 - believed);
  }

  /// True if halving does not help any more: changes stopped shrinking 2 times in a row at the size
  /// of rounding, or 4 times above it.
  bool has_stalled() {
    const bool is_rounding = reference_.error < of_rounding;
    if (stalls_ < (is_rounding ? 2 : 4)) return false;
    if (reference_.error <= reference_bar * tolerance_) return true;
    if (is_rounding) reference_.least_tolerance = reference_.error / reference_bar;
    reference_.failure =
        is_rounding
            ? fmt::format("rounding of f64 leaves {:.1e}, whatever the step; the least tolerance "
                          "that can be judged "
                          "here is {:.1e}",
                          reference_.error, reference_.least_tolerance)
            : fmt::format("{} steps instead of {} still change the {} by {:.1e}: the motion "
                          "amplifies what differs "
                          "(chaos, buckling), so no error can be estimated; take a shorter --end",
                          reference_.levels.back().steps_between * bench_.times().count,
                          reference_.levels[reference_.levels.size() - 2].steps_between *
                              bench_.times().count,
                          name(bench_.quantity()), reference_.error);
    return true;
  }

  bool give_up_for_time(double next_s) {
    if (reference_.error > 0 && reference_.levels.size() > 1 &&
        reference_.error <= reference_bar * tolerance_)
      return false;
    if (reference_.levels.size() > 1) reference_.least_tolerance = reference_.error / reference_bar;
    reference_.failure = fmt::format(
        "a run to estimate errors by needs {:.2g} s more, above what is left of --budget: {:.2g} s",
        next_s, std::max(budget_s_, 0.0));
    return false;
  }

  const Workbench& bench_;
  Configuration next_;
  const double tolerance_;
  double budget_s_;
  int stalls_ = 0, tries_ = 0;
  ReferenceRun reference_;
};

} // namespace

ReferenceRun find_reference(const Workbench& bench, const Configuration& start, double tolerance,
                            double budget_s) {
  return Halving(bench, start, tolerance, budget_s).result();
}

} // namespace dss
