#include "experiments/run/model/model_monitor.hpp"
#include "experiments/base/clock.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

/// Smallest number of checks in a long run. Short runs have fewer, because a check costs as much as
/// some steps.
constexpr long looks_of_a_run = 32;
constexpr long long_interval = 160;   ///< Checks of a short run are at most this many steps apart.
constexpr long looks_of_a_short = 12; ///< smallest number of checks in a short run
constexpr long most_looks = 1024;     ///< largest number of checks, near the bound

constexpr double looks_of_a_period = 8;

/// Steps at which a ramp ends or a table has a point.
std::vector<long> breaks_of(const Problem& problem, double dt) {
  std::vector<long> steps;
  const auto add = [&](double t) {
    if (t > 0 && t / dt < 1e18) steps.push_back(long(std::ceil(t / dt)));
  };
  problem.each_signal([&](const Signal& signal) {
    if (signal.kind == Signal::Kind::ramp) add(signal.duration);
    std::ranges::for_each(signal.times, add);
  });
  std::ranges::sort(steps);
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  return steps;
}

} // namespace

long longest_look_interval(long steps) {
  return std::max({1L, steps / looks_of_a_run, std::min(long_interval, steps / looks_of_a_short)});
}

ModelMonitor::ModelMonitor(const Problem& problem, Model model, double tolerance, long steps,
                           double dt)
    : problem_(problem), model_(model), limit_(bounded_share * tolerance), tolerance_(tolerance),
      dt_(dt), longest_interval_(longest_look_interval(steps)),
      shortest_interval_(std::max(1L, steps / most_looks)), breaks_(breaks_of(problem, dt)),
      good_state_(initial_state(problem)) {
  problem.each_signal([&](const Signal& signal) {
    if (signal.kind != Signal::Kind::harmonic || signal.frequency == 0) return;
    const double period = 1 / std::abs(signal.frequency) / dt;
    if (period < looks_of_a_period * double(longest_interval_))
      longest_interval_ = std::max(1L, long(period / looks_of_a_period));
  });
  largest_ = largest_of_kinds(good_state_);
  begin();
}

void ModelMonitor::begin() {
  failed_state_.clear();
  bound_.emplace(problem_, model_);
  bound_->look(good_state_, double(good_step_) * dt_);
  good_errors_ = bound_->errors();
  interval_ = 1;
}

long ModelMonitor::next_look(long step, long stop) const {
  const auto after = std::ranges::upper_bound(breaks_, step);
  return std::min({step + std::max(1L, interval_), stop, after == breaks_.end() ? stop : *after});
}

KindBounds ModelMonitor::left_out() const {
  KindBounds errors = good_errors_;
  for (std::size_t kind = 0; kind < errors.size(); ++kind) errors[kind] += carried_[kind];
  return errors;
}

double ModelMonitor::estimate_of(const ModelErrorBound& bound, double ahead) const {
  KindBounds errors = bound.errors(ahead);
  for (std::size_t kind = 0; kind < errors.size(); ++kind) errors[kind] += carried_[kind];
  return relative_error(problem_, errors, largest_);
}

bool ModelMonitor::look(Executor& executor, long step) {
  const auto start = Clock::now();
  looked_at_.resize(good_state_.size());
  executor.read(0, looked_at_);
  bound_->look(looked_at_, double(step) * dt_);
  const KindValues now = largest_of_kinds(looked_at_);
  for (std::size_t kind = 0; kind < now.size(); ++kind)
    largest_[kind] = std::max(largest_[kind], now[kind]);
  estimate_ = estimate_of(*bound_, 0);
  ++report_.looks;
  // the motion may change here, so the interval starts small again
  if (std::ranges::binary_search(breaks_, step)) interval_ = 1;
  if (estimate_ <= limit_) adapt_interval();
  const bool is_good = estimate_ <= limit_; // false for NaN
  if (!is_good) {
    failed_step_ = step;
    failed_state_ = looked_at_;
  } else {
    good_step_ = step;
    good_state_.swap(looked_at_);
    good_errors_ = bound_->errors();
    report_.estimate = std::max(report_.estimate, estimate_);
    report_.largest_rotation = std::max(report_.largest_rotation, bound_->largest_rotation());
  }
  report_.look_s += seconds_since(start);
  return is_good;
}

/// Chooses the interval to the next check. It extrapolates the growth of rotations and shortens the
/// interval if the bound would be reached before the next check. If even the shortest interval
/// reaches the bound, the bound counts as exceeded.
void ModelMonitor::adapt_interval() {
  const auto ahead = [&](long steps) { return estimate_of(*bound_, double(steps) * dt_); };
  interval_ = std::min(2 * interval_, longest_interval_);
  while (interval_ > shortest_interval_ && !(ahead(interval_) <= limit_))
    interval_ = std::max(shortest_interval_, interval_ / 2);
  if (interval_ <= shortest_interval_) estimate_ = std::max(estimate_, ahead(interval_));
}

bool ModelMonitor::holds_at_end() const {
  return relative_error(problem_, left_out(), largest_of_kinds(good_state_)) <= tolerance_;
}

Model ModelMonitor::promoted() const {
  for (const Model model : models) {
    const bool is_larger = std::ranges::find(models, model) > std::ranges::find(models, model_);
    if (!is_larger || !has_rotation_vectors(model) || !why_not(model, problem_).empty()) continue;
    ModelErrorBound bound(problem_, model);
    bound.look(good_state_, double(good_step_) * dt_);
    if (!failed_state_.empty()) bound.look(failed_state_, double(failed_step_) * dt_);
    if (estimate_of(bound, double(shortest_interval_) * dt_) <= limit_) return model;
  }
  return Model::spatial;
}

void ModelMonitor::go_on_with(Model model) {
  for (std::size_t kind = 0; kind < carried_.size(); ++kind) carried_[kind] += good_errors_[kind];
  model_ = model;
  begin();
}

} // namespace dss
