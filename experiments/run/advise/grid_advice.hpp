#pragma once
/// Finds the grid that a tolerance needs, if a parameter of the scene refines the grid (`dssbench
/// advise --vary`).
#include "experiments/run/advise/advice.hpp"
#include "experiments/run/state/refinement.hpp"
#include "solver/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// One grid that was computed.
struct GridRun {
  long value = 0; ///< value of the parameter
  std::size_t elements = 0;
  History history;  ///< result by which grids are compared
  double error = 0; ///< estimated, relative
};

/// The chosen grid, and all grids that were computed.
struct GridAdvice {
  std::string failure;       ///< reason why no grid is chosen; empty if one is
  long value = 0;            ///< value of the parameter
  double error = 0;          ///< estimated error of the grid, including that of the limit
  double order = 0;          ///< observed order of convergence
  std::vector<GridRun> runs; ///< by value
};

/// Share of the tolerance for the error of the grid. The rest is for the run on it.
inline constexpr double grid_share = 0.5;

/// Finds the smallest value of a parameter whose grid meets grid_share of the tolerance.
/// First computes the grids with half, once and twice the present value, and extrapolates them to a
/// limit by Richardson (refinement.hpp). Then predicts the value that meets the tolerance. If that
/// is within the computed range, its grid is computed too and compared with the limit. If it is
/// finer, three finer grids follow.
/// Grids are compared by the mean displacement of the first load's elements, or by the total
/// energy, at the saved times. Errors are relative to the largest length of the limit.
/// @throws InputError for a parameter that the scene lacks or that is not a whole number of at
/// least 4, for stress, and for a displacement without a load
GridAdvice advise_grid(const std::string& scene, const std::vector<Override>& overrides,
                       const std::string& parameter, const SavedTimes& times,
                       const AdviseRequest& request,
                       const std::function<void(const std::string&)>& note = {});

} // namespace dss
