#pragma once
/// The link laws by the description of rotations.
#include "solver/model/rotation.hpp"
#include "solver/reference/linearised_law.hpp"
#include "solver/reference/pressure.hpp"
#include "solver/reference/small_law.hpp"

namespace dss::reference {

template <class T>
Reaction<T> reaction_by(Rotation rotation, const Motion<T>& i, const Motion<T>& j,
                        const LinkProperties<T>& link) {
  if (rotation == Rotation::linearised) return linearised_reaction(i, j, link);
  return has_vectors(rotation) ? small_reaction(i, j, link) : reaction(i, j, link);
}

template <class T>
LinkStrain<T> strain_by(Rotation rotation, const Motion<T>& i, const Motion<T>& j,
                        const LinkProperties<T>& link) {
  if (rotation == Rotation::linearised) return linearised_strain(i, j, link);
  const Vector<T> relative =
      has_vectors(rotation) ? Vector<T>(j.q.v - i.q.v) : relative_vector(i.q, j.q);
  return link_strain(i, j, link, relative);
}

template <class T>
Reaction<T> pressure_reaction_by(Rotation rotation, const Motion<T>& i, const Motion<T>& j,
                                 const LinkProperties<T>& link, const LinkPressure<T>& pressure) {
  if (rotation == Rotation::linearised) return linearised_pressure_reaction(link, pressure);
  const RelativeRotation<T> relative =
      has_vectors(rotation) ? RelativeRotation<T>{j.q.v - i.q.v, T(1)} : relative_rotation(i, j);
  return pressure_reaction(i, j, link, relative, pressure);
}

} // namespace dss::reference
