#pragma once
/// What the fields qs .. qz of a state inside the oracle hold, for each Rotation. Outside they are always quaternions.
#include "solver/model/rotation.hpp"
#include "solver/reference/orientation.hpp"

#include <cstddef>
#include <vector>

namespace dss::reference {

/// Middle angle of tait_bryan at which an element's base is taken anew: 45 degrees [rad]. The kinematic equations divide
/// by its cosine, so angular rates, rounding errors and the lengths that bound the error of a step grow by no more than
/// sqrt 2; and a step may turn an element by up to another 45 degrees before it meets the singularity.
inline constexpr double largest_middle_angle = 0.78539816339744831;

/// Coordinates of the orientations of all elements. Those of one element travel as an Orientation that holds the fields
/// qs .. qz as they are: the quaternion itself, or in v the three angles or the rotation vector, with s = 0.
///   tait_bryan      A = X(phi) Y(theta) Z(psi) A_base; write sets the base to the orientation given and the angles to 0
///   tait_bryan_raw  the same with A_base = I for ever
///   linearised, small  rotation vector from the rest orientation, theta' = w
template <class T>
class Coordinates {
public:
  Coordinates(Rotation rotation, std::size_t elements);

  Rotation rotation() const { return rotation_; }
  bool has_vectors() const { return rotation_ == Rotation::linearised || rotation_ == Rotation::small; }

  /// Coordinates of element e at the orientation q.
  Orientation<T> write(std::size_t e, const Orientation<T>& q);
  /// Orientation of element e.
  Orientation<T> read(std::size_t e, const Orientation<T>& c) const;
  /// Time derivative of read for the angular velocity w [rad/s].
  Orientation<T> read_rate(std::size_t e, const Orientation<T>& c, const Vector<T>& w) const;

  /// Time derivative of the coordinates.
  Orientation<T> rate(const Orientation<T>& c, const Vector<T>& w) const;
  /// After a step h [s] of the kinematic equations alone at constant w, to second order and explicitly: the Cayley map of
  /// quaternions, the explicit midpoint rule of angles.
  Orientation<T> moved(const Orientation<T>& c, const Vector<T>& w, T h) const;
  /// m = c + h/2 rate(m, w), half-way of a step of the implicit midpoint rule of the kinematic equation alone, and its
  /// end 2 m - c, which for quaternions is the Cayley map. NaN where the iteration for angles does not converge.
  Orientation<T> midpoint(const Orientation<T>& c, const Vector<T>& w, T h) const;
  Orientation<T> midpoint_end(const Orientation<T>& c, const Vector<T>& w, T h) const;

  /// Takes the base of element e anew if its middle angle has become too large; changes c so that read is as before.
  void reframe(std::size_t e, Orientation<T>& c);

  std::size_t bytes() const { return bases_.size() * sizeof(Orientation<T>); }

private:
  bool has_bases() const { return rotation_ == Rotation::tait_bryan; }

  Rotation rotation_;
  std::vector<Orientation<T>> bases_; ///< of tait_bryan
};

} // namespace dss::reference
