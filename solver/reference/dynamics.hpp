#pragma once
/// The physics of the oracle: the right-hand side of the equations of motion, term by term, and the
/// energy.
#include "solver/model/problem.hpp"
#include "solver/reference/coordinates.hpp"
#include "solver/reference/pressure.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dss::reference {

/// Motion of one element from its field_count numbers, in the order of kernels/fields.hpp.
template <class T>
Motion<T> motion_of(const T* fields);

/// The fields qs .. qz of an element (coordinates.hpp explains their content).
template <class T>
Orientation<T> orientation_fields(const T* fields) {
  return {fields[qs], {fields[qx], fields[qy], fields[qz]}};
}
template <class T>
void set_orientation_fields(T* fields, const Orientation<T>& c) {
  fields[qs] = c.s;
  for (int axis = 0; axis < 3; ++axis) fields[qx + axis] = c.v[axis];
}

/// All terms of a problem: links, extra links, loads, frame acceleration, stabilization, inertia,
/// clamps. Time stepping is not part of it.
template <class T>
class Dynamics {
public:
  /// Copies what it needs; `problem` need not outlive it.
  explicit Dynamics(const Problem& problem, Rotation rotation = Rotation::quaternion);

  std::size_t element_count() const { return elements_.size(); }
  /// Coordinates of orientations in the states that this object takes.
  Coordinates<T>& coordinates() { return coordinates_; }
  const Coordinates<T>& coordinates() const { return coordinates_; }

  /// Time derivative of every field of every element.
  /// @param state, rates  element_count() * field_count numbers, SI units
  /// @param signals       one row as in solver/numerics/signal_rows.hpp: frame acceleration x, y,
  ///     z, then one value a load
  void rates(std::span<const T> state, std::span<const double> signals, std::span<T> rates);

  /// Force and moment about its centre on every element, global frame, 6 numbers each [N], [N m].
  /// The frame's acceleration is included; reactions of clamps are not.
  void wrenches(std::span<const T> state, std::span<const double> signals, std::span<T> wrenches);

  struct Link {
    std::size_t i, j;
    std::size_t properties; ///< index of the constants
  };
  /// Links of the grid, then the extra links.
  const std::vector<Link>& links() const { return links_; }
  /// placed: motion of element e with these fields. link_reaction: what a link does to two elements
  /// with these motions.
  Motion<T> placed(std::size_t e, const T* fields) const;
  Reaction<T> link_reaction(const Motion<T>& i, const Motion<T>& j, const Link& link) const;

  bool has_pressure() const { return !pressures_.empty(); }
  /// Whether the pressures of its elements act on a link. Extra links have none.
  bool has_pressure(const Link& link) const {
    return has_pressure() && properties_[link.properties].area > 0;
  }
  int axis(const Link& link) const { return properties_[link.properties].axis; }
  const LinkProperties<T>& properties(const Link& link) const {
    return properties_[link.properties];
  }
  LinkStrain<T> strain(const Motion<T>& i, const Motion<T>& j, const Link& link) const;
  /// As link_stretch (pressure.hpp), of any link.
  Vector<T> stretch(const Motion<T>& i, const Motion<T>& j, const Link& link) const;
  /// Adds the strain of a link to that of an element, and finds what pressures do to a link.
  void add_strain(const Link& link, const LinkStrain<T>& strain, ElementStrain<T>& sum) const {
    add_link(axis(link), strain, sum);
  }
  /// Pressure [Pa] and moments [N/m] of an element with a strain.
  ElementStrain<T> resistance(std::size_t e, const ElementStrain<T>& strain) const;
  /// @param resistances  of the two elements
  LinkPressure<T> pressure_on(const Link& link, const ElementStrain<T>& i,
                              const ElementStrain<T>& j) const;
  Reaction<T> pressure_reaction_of(const Motion<T>& i, const Motion<T>& j, const Link& link,
                                   const LinkPressure<T>& pressure) const;
  /// Strains of all elements; empty without pressure. @param signals  as in rates(); empty: without
  ///     what loads add
  std::vector<ElementStrain<T>> strains(std::span<const T> state,
                                        std::span<const double> signals) const;
  T volume(std::size_t e) const { return bodies_[std::size_t(elements_[e].body)].volume; }

  /// Kinetic energy, elastic energy of all links and pressures, and energy of the stabilizing
  /// springs [J]. What loads add to pressures counts as their work (supplied_power).
  T energy(std::span<const T> state);
  T kinetic_energy(std::span<const T> state);
  /// Power of the loads and of the frame's acceleration [W]. @param signals as in rates()
  T supplied_power(std::span<const T> state, std::span<const double> signals);
  /// Power that the dampers of links and of the stabilization take [W].
  T dissipated_power(std::span<const T> state);

  /// Memory of tables and scratch space [B].
  std::size_t bytes() const;

private:
  struct Element {
    int body = 0;
    std::uint8_t clamped = 0; ///< bits of Dof
    T mass_ratio = 1;         ///< Problem::mass_ratio
  };
  struct BodyMass {
    T mass;
    Vector<T> inertia;
    bool has_tensor_inertia;
    T volume; ///< [m^3]
  };
  struct Wrench {
    Vector<T> force = Vector<T>::Zero(), moment = Vector<T>::Zero();
  };

  void add_links(const Problem& problem);
  void place(std::span<const T> state);
  void find_wrenches(std::span<const T> state, std::span<const double> signals);
  void add_reaction(const Link& link, const Reaction<T>& reaction);
  void add_link_reactions();
  /// Strains of all elements by their links, and what loads add.
  std::vector<ElementStrain<T>> link_strains(std::span<const Motion<T>> motions) const;
  void add_load_strains(std::span<const double> signals, std::span<ElementStrain<T>> strains) const;
  void add_pressure_reactions(std::span<const ElementStrain<T>> strains);
  void add_loads(std::span<const double> signals);
  void add_stabilization();
  void add_frame_wrenches(std::span<const double> signals);
  T kinetic_energy_of(std::size_t e) const;
  bool is_linearised() const { return coordinates_.rotation() == Rotation::linearised; }
  bool has_vectors() const { return coordinates_.has_vectors(); }
  Matrix<T> body_axes(const Motion<T>& motion) const;
  Vector<T> angular_acceleration(const BodyMass& body, const Motion<T>& motion,
                                 const Vector<T>& moment) const;

  Coordinates<T> coordinates_;
  std::vector<Element> elements_;
  BodyMass mass_of(std::size_t e) const;

  std::vector<BodyMass> bodies_;
  std::vector<LinkProperties<T>> properties_;
  std::vector<Link> links_;
  std::vector<ElementStrain<T>> pressures_; ///< constants of each element; empty if it has none
  std::vector<Load> loads_;
  Stabilization stabilization_;
  std::vector<Vector<T>> rest_;    ///< centres at rest [m], if the frame rotates; else empty
  std::vector<Motion<T>> motions_; ///< of the state under evaluation
  std::vector<Wrench> wrenches_;   ///< on each element
};

} // namespace dss::reference
