#pragma once
/// Steps of implicit methods.
#include "solver/numerics/method.hpp"
#include "variants/sparse/stages.hpp"

#include <optional>
#include <span>
#include <vector>

namespace dss {

/// The steps of one length of an implicit method (solver/numerics/method.hpp). Every solution spans
/// implicit_share(method) of a step.
class ImplicitStep {
public:
  using Vector = Stages::Vector;

  /// @param dt  step [s]; `method` and `stages` outlive it
  ImplicitStep(const Method& method, double dt, Stages& stages)
      : method_(method), dt_(dt), share_(implicit_share(method) * dt), stages_(stages),
        slopes_(std::size_t(method.stages)) {}

  /// Forgets earlier steps.
  void restart() { has_slope_ = false; }
  /// Advances a state by one step.
  /// @param signals  one row for each stage
  /// @return nothing; or the element where no solution was found, and the state is unchanged
  std::optional<std::size_t> advance(Vector& state, std::span<const double> signals);

private:
  std::optional<std::size_t> diagonally_implicit_step(Vector& state,
                                                      std::span<const double> signals);
  std::optional<std::size_t> generalized_alpha_step(Vector& state, std::span<const double> signals);
  std::optional<std::size_t> midpoint_step(Vector& state, std::span<const double> signals);
  void start(const Vector& state, std::span<const double> signals);
  std::span<const double> row(std::span<const double> signals, std::size_t stage) const {
    const std::size_t width = signals.size() / slopes_.size();
    return signals.subspan(stage * width, width);
  }

  const Method& method_;
  double dt_, share_; ///< [s]
  Stages& stages_;
  std::vector<Vector> slopes_; ///< of the stages; the last is kept for the next step
  bool has_slope_ = false;
  Vector base_;
};

} // namespace dss
