#pragma once
/// The numbers of an element's pressure (kernels/link_force/link_force.h) that rows store.
#include "kernels/model.hpp"
#include "kernels/terms.hpp"

#include <type_traits>

namespace dss {

/// Which of P and Q a model's rows have. Models of the plane have no Q, because a plate of one
/// layer bends out of its plane. The model `bending` has no P.
struct PressureParts {
  bool has_volume, has_bending_x, has_bending_y, has_bending_z;
  constexpr int count() const {
    return int(has_volume) + int(has_bending_x) + int(has_bending_y) + int(has_bending_z);
  }
  constexpr bool has_bending() const { return count() > int(has_volume); }
};

constexpr PressureParts pressure_parts(Model model, const Terms& terms) {
  const auto has = [&](Dof dof) { return (degrees_of(model) & dof) != 0; };
  const bool is_any = terms.has_pressure && descriptor(model).axes > 1,
             is_bent = is_any && terms.has_two_shears;
  return {is_any && has(dof_ux), is_bent && has(dof_ry) && has(dof_rz),
          is_bent && has(dof_rz) && has(dof_rx), is_bent && has(dof_rx) && has(dof_ry)};
}

/// The parts as a row stores them, named as in `pressure` of the kernels.
template <class R>
struct NoPressure {};
template <class R>
struct VolumePressure {
  R s;
};
template <class R>
struct BendingPressure {
  R z;
};
template <class R>
struct WholePressure {
  R s, x, y, z;
};
template <class R, Model model, Terms terms>
using StoredPressure = std::conditional_t<
    pressure_parts(model, terms).count() == 4, WholePressure<R>,
    std::conditional_t<pressure_parts(model, terms).has_volume, VolumePressure<R>,
                       std::conditional_t<pressure_parts(model, terms).has_bending(),
                                          BendingPressure<R>, NoPressure<R>>>>;

} // namespace dss
