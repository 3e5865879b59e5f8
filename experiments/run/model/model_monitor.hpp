#pragma once
/// Watches a run with a model of small rotations. It says when to check the state and how large the
/// model's error may be. It keeps the last state with an error within the bound.
#include "experiments/run/model/model_choice.hpp"
#include "experiments/run/model/relative_error.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/model/sufficiency/model_error.hpp"
#include "variants/api/api.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace dss {

/// Largest number of steps between two checks, in a run of `steps` steps.
long longest_look_interval(long steps);

/// A change to a larger model during a run.
struct Promotion {
  long step = 0;         ///< step at which the bound was exceeded
  long resumed_step = 0; ///< step from which the larger model continues
  Model from = Model::spatial, to = Model::spatial;
  double estimate = 0; ///< of the relative error at `step`
};

/// Report on the watched model.
struct ModelReport {
  /// largest rotation of an element from its rest position while the bound held [rad]
  double largest_rotation = 0;
  double estimate = 0; ///< largest bound of the relative error that was accepted
  long looks = 0;
  double look_s = 0; ///< time of all checks; part of the run's time [s]
  std::vector<Promotion> promotions;
};

/// Decides if a model of small rotations is still good enough.
class ModelMonitor {
public:
  /// Watches a run of `steps` steps of dt [s] from the initial state. `problem` must outlive this
  /// object.
  ModelMonitor(const Problem& problem, Model model, double tolerance, long steps, double dt);

  double tolerance() const { return tolerance_; }
  /// Step of the next check, at most `stop`.
  long next_look(long step, long stop) const;
  /// Checks the executor's state after `step` steps.
  /// @return true if the model's error is within its bound, and stays so until the next check if
  /// rotations keep growing as now. The state then becomes the last good one.
  bool look(Executor& executor, long step);
  /// True if the error is within the tolerance relative to the last good state, which is the end of
  /// the run. A motion may end near its rest position, where its own values are small.
  bool holds_at_end() const;
  /// The smallest larger model whose bound accepts both the last good state and the rejected one.
  /// The spatial model is always accepted and needs no watch.
  Model promoted() const;
  /// Continues from the last good state with another model. The error bound of the earlier models
  /// is kept and added.
  void go_on_with(Model model);

  /// Bound of the errors that this model and the earlier ones left in the last good state.
  KindBounds left_out() const;

  double estimate() const { return estimate_; } ///< at the last check
  long good_step() const { return good_step_; }
  const std::vector<double>& good_state() const { return good_state_; }
  const ModelReport& report() const { return report_; }
  void add(const Promotion& promotion) { report_.promotions.push_back(promotion); }
  /// Visits what a continued run needs, apart from promotions (solver/io/kept_numbers.hpp). The
  /// present model is the one that it was made with.
  template <class Visit>
  void each_kept(Visit&& visit) {
    visit(interval_), visit(carried_), visit(largest_), visit(estimate_), visit(good_step_);
    visit(good_state_), visit(good_errors_);
    visit(report_.largest_rotation), visit(report_.estimate), visit(report_.looks);
    bound_->each_kept(visit);
  }

private:
  double estimate_of(const ModelErrorBound& bound, double ahead) const;
  void adapt_interval();
  void begin();

  const Problem& problem_;
  Model model_;
  const double limit_, tolerance_, dt_;
  long longest_interval_;
  const long shortest_interval_;
  std::vector<long> breaks_; ///< steps at which a signal changes its course, ascending
  long interval_ = 1;
  std::optional<ModelErrorBound> bound_;
  KindBounds carried_{}; ///< errors of earlier models
  KindValues largest_{}; ///< largest values during the run
  double estimate_ = 0;
  long good_step_ = 0;
  std::vector<double> good_state_,
      looked_at_; ///< looked_at_ is a member so that a check allocates no memory.
  KindBounds good_errors_{};
  long failed_step_ = 0;
  std::vector<double> failed_state_; ///< the rejected state; empty if it was not finite
  ModelReport report_;
};

} // namespace dss
