#pragma once
/// What the oracle computes for the runs that `verify` checks.
#include "kernels/precision.hpp"
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"

#include <map>
#include <tuple>
#include <vector>

namespace dss {

/// The state at the end of a run, and its step [s].
struct ExpectedRun {
  double dt = 0;
  std::vector<double> state;
};

/// The runs of one problem. Each is computed once for all models with the same equations.
class ExpectedRuns {
public:
  /// @param steps  of a run whose step is not halved
  ExpectedRuns(const Problem& problem, long steps) : problem_(problem), steps_(steps) {}

  /// In extended precision. @param halvings  how often the step is halved and the number of steps
  /// doubled
  const ExpectedRun& run(const Method& method, Rotation equations, int halvings = 0);

  /// Error of the oracle in a precision: how much the motion lets rounding grow.
  double rounding_error(const Method& method, Rotation equations, Precision precision);

private:
  template <class T>
  std::vector<double> computed(const Method& method, Rotation equations, double dt,
                               long steps) const;

  const Problem& problem_;
  const long steps_;
  std::map<std::tuple<const Method*, Rotation, int>, ExpectedRun> runs_;
};

} // namespace dss
