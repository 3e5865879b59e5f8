#pragma once
/// Content of the fields qs .. qz of a state inside the oracle, for each Rotation. Outside the
/// oracle they are always quaternions.
#include "solver/model/rotation.hpp"
#include "solver/reference/orientation.hpp"

#include <cstddef>
#include <vector>

namespace dss::reference {

/// Middle angle at which tait_bryan restarts its base: 45 degrees, in [rad]. The kinematic
/// equations divide by its cosine. So angular rates, rounding errors and the lengths that bound the
/// error of a step grow by at most sqrt 2. A step may turn an element by 45 degrees more before it
/// meets the singularity.
inline constexpr double largest_middle_angle = 0.78539816339744831;

/// Coordinates of the orientations of all elements. The coordinates of one element are passed as an
/// Orientation that holds the fields qs .. qz: the quaternion; or, with s = 0, the three angles or
/// the rotation vector in v.
///   tait_bryan             A = X(phi) Y(theta) Z(psi) A_base; write sets A_base to the given
///                          orientation and the angles to 0
///   tait_bryan_every_step  the same; the base restarts after every step
///   tait_bryan_raw         the same, with A_base = I always
///   linearised, small      rotation vector from the rest orientation, theta' = w
template <class T>
class Coordinates {
public:
  Coordinates(Rotation rotation, std::size_t elements);

  Rotation rotation() const { return rotation_; }
  bool has_vectors() const { return dss::has_vectors(rotation_); }

  /// Coordinates of element e for the orientation q.
  Orientation<T> write(std::size_t e, const Orientation<T>& q);
  /// Orientation of element e for the coordinates c.
  Orientation<T> read(std::size_t e, const Orientation<T>& c) const;
  /// Time derivative of read(e, c) for the angular velocity w [rad/s].
  Orientation<T> read_rate(std::size_t e, const Orientation<T>& c, const Vector<T>& w) const;

  /// Time derivative of the coordinates for the angular velocity w [rad/s].
  Orientation<T> rate(const Orientation<T>& c, const Vector<T>& w) const;
  /// Coordinates after a step h [s] of the kinematic equations at constant w: explicit, of second
  /// order. Quaternions use the Cayley map, angles the explicit midpoint rule.
  Orientation<T> moved(const Orientation<T>& c, const Vector<T>& w, T h) const;
  /// midpoint solves m = c + h/2 rate(m, w): the middle of a step h [s] of the implicit midpoint
  /// rule for the kinematic equation. midpoint_end is the end of that step, 2 m - c; for
  /// quaternions it is the Cayley map. NaN if the iteration for angles does not converge.
  Orientation<T> midpoint(const Orientation<T>& c, const Vector<T>& w, T h) const;
  Orientation<T> midpoint_end(const Orientation<T>& c, const Vector<T>& w, T h) const;

  /// Restarts the base of element e after a step, if its middle angle is too large or the rotation
  /// restarts after every step. Changes c so that read(e, c) stays the same.
  void reframe(std::size_t e, Orientation<T>& c);

  /// True if elements have bases that can restart.
  bool has_bases() const {
    return rotation_ == Rotation::tait_bryan || rotation_ == Rotation::tait_bryan_every_step;
  }
  std::size_t bytes() const { return bases_.size() * sizeof(Orientation<T>); }

private:
  Rotation rotation_;
  std::vector<Orientation<T>> bases_; ///< A_base of each element
};

} // namespace dss::reference
