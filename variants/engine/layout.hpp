#pragma once
/// Which of the 13 fields, six wrench components and six clamp bits a model keeps, in the order in which its packs hold
/// them.
#include "solver/model/fields.hpp"
#include "solver/model/model.hpp"

#include <span>

namespace dss {

struct ModelLayout {
  std::span<const Field> fields;
  std::span<const int> wrench; ///< of force x, y, z, moment x, y, z; also the bits of Dof
  int vec_size;                ///< the first components of the wrench that are forces
};

inline ModelLayout model_layout(Model model) {
  static constexpr Field spatial[] = {ux, uy, uz, vx, vy, vz, qs, qx, qy, qz, wx, wy, wz};
  static constexpr Field planar[] = {ux, uy, vx, vy, qs, qz, wz};
  static constexpr int spatial_wrench[] = {0, 1, 2, 3, 4, 5};
  static constexpr int planar_wrench[] = {0, 1, 5};
  if (model == Model::planar) return {planar, planar_wrench, 2};
  return {spatial, spatial_wrench, 3};
}

} // namespace dss
