#pragma once
/// How far a run is from the solution of its scene, over the saved times.
#include "solver/model/problem.hpp"

#include "experiments/runner/state_access.hpp"

#include <span>
#include <vector>

namespace dss {

/// Relative errors. At one time the error of a kind of field is its largest difference over all elements and axes, over the kind's scale:
/// the largest expected number at any saved time (error_scales of state_access.hpp). Displacements are the headline.
struct Accuracy {
  double final = 0;                            ///< displacement, at the last saved time
  double l2 = 0;                               ///< displacement, root mean square over the saved times
  double max = 0;                              ///< displacement, largest over the saved times
  double rotation = 0, velocity = 0, spin = 0; ///< of q, v, w: largest over the saved times
};

/// Gathers the errors of a run as it comes by the saved times.
class AccuracyMeter {
public:
  /// @param expected  states at the saved times; outlives the meter
  AccuracyMeter(const Problem& problem, const std::vector<std::vector<double>>& expected);
  /// State at saved time number k, from 0 on.
  void add(std::size_t k, std::span<const double> state);
  /// @pre every saved time was added
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
