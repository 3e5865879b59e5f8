#pragma once
/// What of a problem the bound of a model's error rests on (model_error.hpp).
#include "solver/model/problem.hpp"

namespace dss {

struct BoundStructure {
  bool is_flat =
      false; ///< why_not_bending is empty: mirrored, the motion is its own negative, and what is left out is even in it
  bool is_tree = false; ///< links close no circle between clamped elements: arms of wrong length strain nothing
  bool is_held =
      false;         ///< every element hangs on a clamped one by links that all resist bending and shear: no mechanism
  double length = 0; ///< of the longest way through the bodies [m]
  double least_buckling =
      0;                ///< load of a column of that length of the weakest link, clamped at one end [N]; 0: a mechanism
  double stiffness = 0; ///< k_normal of the stiffest link [N/m]
  double edge = 0, shortest_edge = 0; ///< longest and shortest [m]
  double mass = 0, inertia = 0;       ///< least of an element [kg], [kg m^2]
};
BoundStructure bound_structure(const Problem& problem);

} // namespace dss
