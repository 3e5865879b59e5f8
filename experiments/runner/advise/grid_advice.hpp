#pragma once
/// How fine a grid a tolerance asks for, where a parameter of the scene refines it (`dssbench advise --vary`).
#include "experiments/runner/advise/advise.hpp"
#include "experiments/runner/precision/refinement.hpp"
#include "solver/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// One grid that was computed.
struct GridRun {
  long value = 0; ///< of the parameter
  std::size_t elements = 0;
  History history;  ///< of what grids are compared by
  double error = 0; ///< estimated, relative
};

struct GridAdvice {
  std::string failure;       ///< empty, or why no grid is chosen
  long value = 0;            ///< of the parameter
  double error = 0;          ///< of its grid, estimated, with that of the limit
  double order = 0;          ///< observed
  std::vector<GridRun> runs; ///< by value
};

/// Part of the tolerance that a grid may take; the rest is left to the run on it.
inline constexpr double grid_share = 0.5;

/// Grids of half, once and twice the parameter's value, extrapolated by Richardson (refinement.hpp); the smallest value whose predicted error is within
/// grid_share of the tolerance is computed too, and held against the limit. Where that is finer than the grids, three finer ones are taken.
/// Compared are the mean displacement of the elements of the first load, or the total energy, at the saved times, each over the largest; what is compared is relative to the limit.
/// @throws InputError for a parameter that the scene lacks or that is no whole number of 4 or more, for stress, and for a scene without a load
GridAdvice advise_grid(const std::string& scene, const std::vector<Override>& overrides, const std::string& parameter,
                       const SavedTimes& times, const AdviseRequest& request,
                       const std::function<void(const std::string&)>& note = {});

} // namespace dss
