#pragma once
/// Which of the 13 fields, six wrench components and six clamp bits a model has. Packs hold them in
/// this order. A wrench is a force with a moment.
#include "kernels/fields.hpp"
#include "kernels/model.hpp"

#include <span>

namespace dss {

struct ModelLayout {
  std::span<const Field> fields;
  std::span<const int> wrench; ///< indices into force x, y, z, moment x, y, z; also the bits of Dof
  int vec_size;                ///< how many of the wrench components are forces
  int axes;                    ///< number of axes x, y, z along which elements have links
  bool has_vectors = false;    ///< qx, qy, qz hold half of the rotation vector
};

inline ModelLayout model_layout(Model model) {
  static constexpr Field spatial[] = {ux, uy, uz, vx, vy, vz, qs, qx, qy, qz, wx, wy, wz};
  static constexpr Field vectors[] = {ux, uy, uz, vx, vy, vz, qx, qy, qz, wx, wy, wz};
  static constexpr Field bending[] = {uz, vz, qx, qy, wx, wy};
  static constexpr Field membrane[] = {ux, uy, vx, vy, qz, wz};
  static constexpr Field planar[] = {ux, uy, vx, vy, qs, qz, wz};
  static constexpr Field axial[] = {ux, vx};
  static constexpr int all_wrench[] = {0, 1, 2, 3, 4, 5}, bending_wrench[] = {2, 3, 4},
                       planar_wrench[] = {0, 1, 5}, axial_wrench[] = {0};
  switch (model) {
  case Model::axial:
    return {axial, axial_wrench, 1, 1};
  case Model::bending:
    return {bending, bending_wrench, 1, 2, true};
  case Model::membrane:
    return {membrane, planar_wrench, 2, 2, true};
  case Model::planar:
    return {planar, planar_wrench, 2, 2};
  case Model::linear:
  case Model::small:
    return {vectors, all_wrench, 3, 3, true};
  case Model::spatial:
    break;
  }
  return {spatial, all_wrench, 3, 3};
}

} // namespace dss
