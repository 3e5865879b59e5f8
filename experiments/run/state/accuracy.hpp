#pragma once
/// Errors of a run against the solution of its scene, over the saved times.
#include "solver/model/problem.hpp"

#include "experiments/run/state/state_access.hpp"

#include <span>
#include <vector>

namespace dss {

/// Relative errors. A kind is u, q, v or w. The error of a kind at one time is its largest
/// difference over all elements and axes, divided by the kind's scale. The scale is the largest
/// expected number at any saved time (error_scales of state_access.hpp). Displacements are the main
/// figure.
struct Accuracy {
  double final = 0; ///< displacement, at the last saved time
  double l2 = 0;    ///< displacement, root mean square over the saved times
  double max = 0;   ///< displacement, largest over the saved times
  double rotation = 0, velocity = 0, spin = 0; ///< of q, v, w: largest over the saved times
};

/// Collects the errors of a run at its saved times.
class AccuracyMeter {
public:
  /// @param expected  states at the saved times; must outlive the meter
  AccuracyMeter(const Problem& problem, const std::vector<std::vector<double>>& expected);
  /// Adds the state at saved time k, counted from 0.
  void add(std::size_t k, std::span<const double> state);
  /// Requires that every saved time was added.
  Accuracy result() const;

private:
  const std::vector<std::vector<double>>& expected_;
  KindValues scales_;
  std::vector<KindValues> errors_; ///< by saved time
};

/// Errors of states at all saved times.
Accuracy accuracy_of(const Problem& problem, const std::vector<std::vector<double>>& expected,
                     const std::vector<std::vector<double>>& actual);

} // namespace dss
