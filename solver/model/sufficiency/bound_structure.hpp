#pragma once
/// Properties of a problem that the bound of a model's error uses (model_error.hpp).
#include "solver/model/problem.hpp"

namespace dss {

/// Properties of a problem; README.md explains their use.
struct BoundStructure {
  /// why_not_bending is empty. The mirrored motion is then the negative motion, so the terms that
  /// the model leaves out are even in the motion.
  bool is_flat = false;
  /// Links close no circle between clamped elements, so arms of wrong length strain nothing.
  bool is_tree = false;
  /// No mechanism: every element is connected to a clamped one by links that resist bending and
  /// shear.
  bool is_held = false;
  double length = 0; ///< longest path through the bodies [m]
  /// Euler load [N] of a column of that length, made of the weakest link and clamped at one end; 0:
  /// a mechanism.
  double least_buckling = 0;
  double stiffness = 0;               ///< k_normal of the stiffest link [N/m]
  double edge = 0, shortest_edge = 0; ///< longest and shortest edge [m]
  double mass = 0, inertia = 0;       ///< smallest of all elements [kg], [kg m^2]
};
BoundStructure bound_structure(const Problem& problem);

} // namespace dss
