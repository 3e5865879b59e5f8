#pragma once
/// The watch over a run with a model of small rotations: when to look at its state, how large the model's error may be, and the last state at which it was
/// within its bound.
#include "experiments/runner/model/model_choice.hpp"
#include "experiments/runner/state_access.hpp"
#include "solver/model/sufficiency/model_error.hpp"
#include "variants/api.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace dss {

/// The largest of the errors over what each kind is measured against (error_scales); infinite where that is zero.
double relative_error(const Problem& problem, const KindBounds& errors, const KindValues& largest);

/// Most steps between two looks at a run of so many.
long longest_look_interval(long steps);

/// A run continued with a larger model.
struct Promotion {
  long step = 0;         ///< at which the bound was exceeded
  long resumed_step = 0; ///< from whose state the larger model goes on
  Model from = Model::spatial, to = Model::spatial;
  double estimate = 0; ///< of the error at `step`
};

/// What became of the choice.
struct ModelReport {
  double largest_rotation = 0; ///< of an element against its rest, where the bound held [rad]
  double estimate = 0;         ///< largest bound of the relative error that was accepted
  long looks = 0;
  double look_s = 0; ///< time of all looks; part of the run's [s]
  std::vector<Promotion> promotions;
};

class ModelMonitor {
public:
  /// Watches a run of so many steps of dt [s] from its initial state. `problem` must outlive it.
  ModelMonitor(const Problem& problem, Model model, double tolerance, long steps, double dt);

  double tolerance() const { return tolerance_; }
  /// The step at which to look next, at most `stop`.
  long next_look(long step, long stop) const;
  /// Looks at the executor's state after `step` steps. @return whether the model's error is within its bound, also if rotations go on as they do until the
  /// next look; if so, that state is the last good one
  bool look(Executor& executor, long step);
  /// Whether the error is within the tolerance of what the last good state, the end, has itself: a motion may end where it passes its rest.
  bool holds_at_end() const;
  /// The next larger model whose bound allows the last good state and the one that was refused, or spatial, which needs no watch any more.
  Model promoted() const;
  /// Goes on from the last good state with another model; what the first one may have left out stays in the account.
  void go_on_with(Model model);

  /// Errors that this model and those before it may have left in the last good state.
  KindBounds left_out() const;

  double estimate() const { return estimate_; } ///< at the last look
  long good_step() const { return good_step_; }
  const std::vector<double>& good_state() const { return good_state_; }
  const ModelReport& report() const { return report_; }
  void add(const Promotion& promotion) { report_.promotions.push_back(promotion); }

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
  KindValues largest_{}; ///< of the run
  double estimate_ = 0;
  long good_step_ = 0;
  std::vector<double> good_state_, looked_at_; ///< the second is kept so that a look allocates nothing
  KindBounds good_errors_{};
  long failed_step_ = 0;
  std::vector<double> failed_state_; ///< that a look refused, and not a number that was not finite
  ModelReport report_;
};

} // namespace dss
