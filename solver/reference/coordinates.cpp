#include "solver/reference/coordinates.hpp"

#include "solver/reference/real_types.hpp"
#include "solver/reference/rotation_vector.hpp"
#include "solver/reference/tait_bryan.hpp"

#include <cmath>
#include <limits>

namespace dss::reference {

template <class T>
Coordinates<T>::Coordinates(Rotation rotation, std::size_t elements)
    : rotation_(rotation), bases_(has_bases() ? elements : 0) {}

template <class T>
Orientation<T> Coordinates<T>::write(std::size_t e, const Orientation<T>& q) {
  switch (rotation_) {
  case Rotation::quaternion:
    break;
  case Rotation::tait_bryan:
  case Rotation::tait_bryan_every_step:
    bases_[e] = q;
    return {};
  case Rotation::tait_bryan_raw:
    return {T(0), angles_of(q)};
  case Rotation::linearised:
  case Rotation::small:
    return {T(0), vector_of_orientation(q)};
  }
  return q;
}

template <class T>
Orientation<T> Coordinates<T>::read(std::size_t e, const Orientation<T>& c) const {
  switch (rotation_) {
  case Rotation::quaternion:
    break;
  case Rotation::tait_bryan:
  case Rotation::tait_bryan_every_step:
    return product(orientation_of_angles(c.v), bases_[e]);
  case Rotation::tait_bryan_raw:
    return orientation_of_angles(c.v);
  case Rotation::linearised:
  case Rotation::small:
    return orientation_of_vector(c.v);
  }
  return c;
}

template <class T>
Orientation<T> Coordinates<T>::read_rate(std::size_t e, const Orientation<T>& c,
                                         const Vector<T>& w) const {
  if (has_vectors()) return rate_along_vector(c.v, w);
  return reference::rate(read(e, c), w);
}

template <class T>
Orientation<T> Coordinates<T>::rate(const Orientation<T>& c, const Vector<T>& w) const {
  if (rotation_ == Rotation::quaternion) return reference::rate(c, w);
  if (has_vectors()) return {T(0), w};
  return {T(0), angle_rates(c.v, w)};
}

template <class T>
Orientation<T> Coordinates<T>::moved(const Orientation<T>& c, const Vector<T>& w, T h) const {
  if (rotation_ == Rotation::quaternion) return cayley_turned<T>(c, h * w);
  if (has_vectors()) return {T(0), c.v + h * w};
  const Vector<T> middle = c.v + h / T(2) * angle_rates(c.v, w);
  return {T(0), c.v + h * angle_rates(middle, w)};
}

template <class T>
Orientation<T> Coordinates<T>::midpoint(const Orientation<T>& c, const Vector<T>& w, T h) const {
  if (has_vectors()) return {T(0), c.v + h / T(2) * w};
  if (rotation_ == Rotation::quaternion) {
    const Orientation<T> end = cayley_turned<T>(c, h * w);
    return {(c.s + end.s) / T(2), (c.v + end.v) / T(2)};
  }
  // Each pass multiplies the error by about h |w|. Iterates until the change is at rounding and no
  // longer falls.
  constexpr int most_passes = 100;
  Vector<T> middle = c.v;
  T last = std::numeric_limits<T>::infinity();
  for (int pass = 0; pass < most_passes; ++pass) {
    const Vector<T> next = c.v + h / T(2) * angle_rates(middle, w);
    const T change = (next - middle).norm();
    middle = next;
    const T rounding = std::numeric_limits<T>::epsilon() * (T(1) + middle.norm());
    if (change == T(0) || (change >= last && change <= T(4) * rounding)) return {T(0), middle};
    last = change;
  }
  return {T(0), Vector<T>::Constant(std::numeric_limits<T>::quiet_NaN())};
}

template <class T>
Orientation<T> Coordinates<T>::midpoint_end(const Orientation<T>& c, const Vector<T>& w,
                                            T h) const {
  if (rotation_ == Rotation::quaternion) return cayley_turned<T>(c, h * w);
  return {T(0), T(2) * midpoint(c, w, h).v - c.v};
}

template <class T>
void Coordinates<T>::reframe(std::size_t e, Orientation<T>& c) {
  if (rotation_ == Rotation::tait_bryan_every_step ||
      (has_bases() && std::abs(c.v.y()) > T(largest_middle_angle)))
    c = write(e, read(e, c));
}

#define DSS_INSTANTIATE(T) template class Coordinates<T>;
DSS_EACH_REAL(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::reference
