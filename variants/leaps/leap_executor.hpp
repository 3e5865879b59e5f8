#pragma once
/// The method `chebyshev` on any variant: exact leaps of undamped linear models, as sums over the
/// states of runs by symplectic Euler (solver/numerics/leap_weights.hpp has the equations).
#include "solver/numerics/leap_weights.hpp"
#include "variants/api/api.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace dss {

/// Why an exponential method cannot compute a problem with a model, after "--integrator NAME: ";
/// empty if it can, and for other methods.
std::string why_not_exponential(const Method& method, const Problem& problem, Model model,
                                Precision precision, Rotation rotation);

/// Makes the executor of a setup: the plug-in's own, or one that computes by leaps on it.
/// @throws InputError as why_not_exponential, or if the variant does not give out its state
std::unique_ptr<Executor> make_executor(const Plugin& plugin, const Setup& setup);

/// Each call of advance() is one leap, or several if it is long. A leap takes a run from the
/// displacements, one from the velocities unless all are zero, and one for each signal that
/// changes. If the leap before had the same length, the state before it replaces the run from the
/// velocities:
///     x(t + L) + x(t - L) = 2 cos(L A^(1/2)) x(t) + what loads add, f(t + s) + f(t - s) for f(s)
/// This form lets errors grow with the square of the number of leaps, so it is left now and then.
class LeapExecutor final : public Executor, public EvaluationCount {
public:
  LeapExecutor(const Plugin& plugin, const Setup& setup);

  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
  std::string schedule() const override;
  int workers() const override { return inner_->workers(); }
  std::size_t bytes() const override;
  DeviceWork* device_work() override { return inner_->device_work(); }
  RankGroup* rank_group() override { return inner_->rank_group(); }
  HybridMembers* hybrid_members() override { return inner_->hybrid_members(); }
  EvaluationCount* evaluation_count() override { return this; }
  double evaluations() const override { return evaluations_; }

private:
  /// A displacement, or half of a turn, among the numbers of an element, and its rate times `half`.
  struct Moving {
    std::size_t at, rate;
    double half;
  };
  using Numbers = std::vector<double>; ///< width_ for each element
  struct Leap {
    long steps;
    Numbers state;            ///< before it
    std::vector<double> rows; ///< of signals
  };

  /// Calls visit(displacement, rate, half), the first two being places in state_.
  template <class Visit>
  void each_moving(Visit&& visit) const;
  bool is_moving() const;
  /// What runs start from: the displacements without velocities, the velocities, nothing.
  Numbers of_displacements() const;
  Numbers of_velocities() const;
  Numbers at_rest() const;
  void move_inside(); ///< Makes the inner executor hold state_.
  /// Adds `factor` times the weighted states of a run under constant signals.
  Outcome add_run(const Numbers& start, std::span<const double> signals,
                  const StateWeights& weights, double factor);
  Outcome leap(long steps, std::span<const double> signals);
  Outcome add_runs(const LeapWeights& weights, std::span<const double> signals);
  void begin_sum();

  const Setup setup_;
  const double omega_;
  const Method& method_; ///< of the runs
  std::unique_ptr<Executor> inner_;
  std::size_t width_;
  std::vector<Moving> moving_;
  Numbers state_, sum_, piece_;
  bool is_inside_ = true; ///< the inner executor holds state_
  std::optional<Leap> before_;
  int leaps_ = 0; ///< since the last run from velocities
  double evaluations_ = 0;
};

} // namespace dss
