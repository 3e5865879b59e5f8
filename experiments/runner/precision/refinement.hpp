#pragma once
/// Richardson's extrapolation of a quantity over three grids (L. F. Richardson, Phil. Trans. R. Soc. A 210 (1911) 307-357).
#include "solver/model/fields.hpp"

#include <array>
#include <vector>

namespace dss {

/// A vector at each saved time, as displacements [m].
using History = std::vector<Vec3>;

struct Extrapolation {
  double order = 0;       ///< observed: of the rms differences of successive grids over the saved times
  bool converges = false; ///< differences shrink from grid to grid; else what follows is a difference, not an error
  double error =
      0; ///< of the first grid: largest distance from the extrapolated history over that one's largest length
  double error_final = 0; ///< the same at the last time
  double value = 0;       ///< length of the extrapolated vector at the last time
};

/// @param grids  histories on three grids, the coarsest first  @param ratio  of their spacings, above 1
/// @param has_limit  the grids are of one body; if not, they are treated as those that do not converge
Extrapolation extrapolate(const std::array<History, 3>& grids, double ratio, bool has_limit = true);

} // namespace dss
