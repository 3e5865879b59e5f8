#pragma once
/// Richardson's extrapolation of a quantity over three grids (L. F. Richardson, Phil. Trans. R.
/// Soc. A 210 (1911) 307-357).
#include "kernels/fields.hpp"

#include <array>
#include <vector>

namespace dss {

/// A vector at each saved time, such as a displacement [m].
using History = std::vector<Vec3>;

/// Observed order, limit, and error of the first grid.
struct Extrapolation {
  double order = 0; ///< observed, from the rms differences of successive grids over the saved times
  /// True if differences shrink from grid to grid. If false, the members below are differences, not
  /// errors.
  bool converges = false;
  /// Of the first grid: largest distance from the extrapolated history, relative to that history's
  /// largest length.
  double error = 0;
  double error_final = 0; ///< the same at the last time
  double value = 0;       ///< length of the extrapolated vector at the last time
};

/// Extrapolates with the observed order p: limit = fine + (fine - middle) / (ratio^p - 1).
/// @param grids  histories on three grids, the coarsest first
/// @param ratio  ratio of their spacings, above 1
/// @param has_limit  false: the grids are not of one body, and the result has `converges` = false
Extrapolation extrapolate(const std::array<History, 3>& grids, double ratio, bool has_limit = true);

} // namespace dss
