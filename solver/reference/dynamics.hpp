#pragma once
/// The right-hand side of a problem's equations of motion, term by term, and its energy: the physics of the oracle.
#include "solver/model/problem.hpp"
#include "solver/reference/coordinates.hpp"
#include "solver/reference/link_law.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dss::reference {

/// Element of a state: field_count numbers in the order of solver/model/fields.hpp.
template <class T>
Motion<T> motion_of(const T* fields);

/// The fields qs .. qz of an element, whatever they hold (coordinates.hpp).
template <class T>
Orientation<T> orientation_fields(const T* fields) {
  return {fields[qs], {fields[qx], fields[qy], fields[qz]}};
}
template <class T>
void set_orientation_fields(T* fields, const Orientation<T>& c) {
  fields[qs] = c.s;
  for (int axis = 0; axis < 3; ++axis) fields[qx + axis] = c.v[axis];
}

/// Every term of a problem but time: links, extra links, loads, frame acceleration, stabilization, inertia, clamps.
template <class T>
class Dynamics {
public:
  /// Copies what it needs; the problem may end before.
  explicit Dynamics(const Problem& problem, Rotation rotation = Rotation::quaternion);

  std::size_t element_count() const { return elements_.size(); }
  /// What the fields qs .. qz of states hold here.
  Coordinates<T>& coordinates() { return coordinates_; }
  const Coordinates<T>& coordinates() const { return coordinates_; }

  /// Time derivative of every field of every element.
  /// @param state, rates  element_count() * field_count numbers, SI units
  /// @param signals       one row as in solver/numerics/signal_rows.hpp: frame acceleration x, y, z, then one value a
  /// load
  void rates(std::span<const T> state, std::span<const double> signals, std::span<T> rates);

  /// Force and moment about its centre on every element, global frame: 6 numbers each [N], [N m]. What holds clamped degrees of freedom is
  /// not in it, the frame's acceleration is.
  void wrenches(std::span<const T> state, std::span<const double> signals, std::span<T> wrenches);

  struct Link {
    std::size_t i, j;
    std::size_t properties; ///< its constants
  };
  /// Of the grid, then the extra ones.
  const std::vector<Link>& links() const { return links_; }
  /// Motion of element e whose fields are these, and what a link does to two elements that move so.
  Motion<T> placed(std::size_t e, const T* fields) const;
  Reaction<T> link_reaction(const Motion<T>& i, const Motion<T>& j, const Link& link) const;

  /// Kinetic energy, plus elastic energy of all links, plus that of the stabilizing springs [J].
  T energy(std::span<const T> state);

  /// Bytes of the tables and scratch space held.
  std::size_t bytes() const;

private:
  struct Element {
    int body = 0;
    std::uint8_t clamped = 0; ///< bits of Dof
  };
  struct BodyMass {
    T mass;
    Vector<T> inertia;
    bool has_tensor_inertia;
  };
  struct Wrench {
    Vector<T> force = Vector<T>::Zero(), moment = Vector<T>::Zero();
  };

  void add_links(const Problem& problem);
  void place(std::span<const T> state);
  void find_wrenches(std::span<const T> state, std::span<const double> signals);
  void add_link_reactions();
  void add_loads(std::span<const double> signals);
  void add_stabilization();
  bool is_linearised() const { return coordinates_.rotation() == Rotation::linearised; }
  bool has_vectors() const { return coordinates_.has_vectors(); }
  Matrix<T> body_axes(const Motion<T>& motion) const;
  Vector<T> angular_acceleration(const BodyMass& body, const Motion<T>& motion, const Vector<T>& moment) const;

  Coordinates<T> coordinates_;
  std::vector<Element> elements_;
  std::vector<BodyMass> bodies_;
  std::vector<LinkProperties<T>> properties_;
  std::vector<Link> links_;
  std::vector<Load> loads_;
  Stabilization stabilization_;
  std::vector<Motion<T>> motions_; ///< of the state being evaluated
  std::vector<Wrench> wrenches_;   ///< on each element
};

} // namespace dss::reference
