#include "solver/reference/dynamics.hpp"

#include "solver/reference/laws.hpp"
#include "solver/reference/real_types.hpp"

#include <algorithm>

namespace dss::reference {
namespace {

template <class T>
Vector<T> vector_of(const Vec3& v) {
  return {T(v[0]), T(v[1]), T(v[2])};
}

template <class T>
LinkProperties<T> properties_of(LinkLaw law, int axis, const AxisConstants& c, const Vec3& edge_i,
                                const Vec3& edge_j) {
  const auto a = std::size_t(axis);
  LinkProperties<T> link;
  link.law = law;
  link.axis = axis;
  link.arm_i = Vector<T>::Unit(axis) * T(edge_i[a]) / T(2);
  link.arm_j = Vector<T>::Unit(axis) * T(edge_j[a]) / T(2);
  link.k_normal = T(c.k_normal);
  link.d_normal = T(c.d_normal);
  link.k_shear = vector_of<T>(c.k_shear);
  link.d_shear = vector_of<T>(c.d_shear);
  link.k_rot = vector_of<T>(c.k_rot);
  link.d_rot = vector_of<T>(c.d_rot);
  return link;
}

} // namespace

template <class T>
Motion<T> motion_of(const T* f) {
  Motion<T> motion;
  motion.u << f[ux], f[uy], f[uz];
  motion.v << f[vx], f[vy], f[vz];
  motion.w << f[wx], f[wy], f[wz];
  motion.q = orientation_fields(f);
  motion.turned = turn(motion.q);
  return motion;
}

template <class T>
Dynamics<T>::Dynamics(const Problem& problem, Rotation rotation)
    : coordinates_(rotation, problem.lattice.element_count),
      elements_(problem.lattice.element_count), loads_(problem.loads),
      stabilization_(problem.stabilization), motions_(problem.lattice.element_count),
      wrenches_(problem.lattice.element_count) {
  for (const Body& body : problem.bodies)
    bodies_.push_back({T(body.mass), vector_of<T>(body.inertia), body.has_tensor_inertia(),
                       T(body.edge[0]) * T(body.edge[1]) * T(body.edge[2])});
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { elements_[e].body = row.body; });
  for (std::size_t e = 0; e < elements_.size() && problem.has_mass_ratios(); ++e)
    elements_[e].mass_ratio =
        T(problem.mass_ratio(e, problem.bodies[std::size_t(elements_[e].body)]));
  for (const Clamp& clamp : problem.clamps) elements_[clamp.element].clamped |= clamp.dofs;
  for (std::size_t e = 0; e < elements_.size() && problem.has_pressure(); ++e) {
    const ElementPressure pressure =
        problem.pressure(e, problem.bodies[std::size_t(elements_[e].body)]);
    pressures_.push_back({T(pressure.volume), vector_of<T>(pressure.bending)});
  }
  if (problem.has_rotating_frame()) {
    rest_.resize(elements_.size());
    problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
      rest_[e] = vector_of<T>(rest_position(problem, row, x));
    });
  }
  add_links(problem);
}

template <class T>
void Dynamics<T>::add_links(const Problem& problem) {
  std::vector<std::size_t> first_kind; // of each body
  for (const Body& body : problem.bodies) {
    first_kind.push_back(properties_.size());
    body.each_kind([&](const AxisConstants& constants, int axis) {
      properties_.push_back(properties_of<T>(body.law, axis, constants, body.edge, body.edge));
      if (!body.pressures.empty())
        properties_.back().area =
            bodies_[first_kind.size() - 1].volume / T(body.edge[std::size_t(axis)]);
    });
  }
  links_.reserve(problem.link_count());
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    links_.push_back({i, j,
                      first_kind[std::size_t(elements_[i].body)] + 3 * problem.link_kind(i, axis) +
                          std::size_t(axis)});
  });
  for (const ExtraLink& extra : problem.extra_links) {
    const Body& body_i = problem.bodies[std::size_t(elements_[extra.i].body)];
    const Body& body_j = problem.bodies[std::size_t(elements_[extra.j].body)];
    links_.push_back({extra.i, extra.j, properties_.size()});
    properties_.push_back(
        properties_of<T>(extra.law, extra.axis, extra.constants, body_i.edge, body_j.edge));
  }
}

template <class T>
Motion<T> Dynamics<T>::placed(std::size_t e, const T* fields) const {
  Motion<T> motion = motion_of(fields);
  if (coordinates_.rotation() == Rotation::quaternion) return motion;
  if (has_vectors()) {
    motion.turned = cross_matrix<T>(motion.q.v);
    motion.q.v /= T(2);
  } else {
    motion.q = coordinates_.read(e, motion.q);
    motion.turned = turn(motion.q);
  }
  return motion;
}

template <class T>
void Dynamics<T>::place(std::span<const T> state) {
  for (std::size_t e = 0; e < elements_.size(); ++e)
    motions_[e] = placed(e, state.data() + e * field_count);
}

template <class T>
Reaction<T> Dynamics<T>::link_reaction(const Motion<T>& i, const Motion<T>& j,
                                       const Link& link) const {
  return reaction_by(coordinates_.rotation(), i, j, properties_[link.properties]);
}

template <class T>
void Dynamics<T>::add_reaction(const Link& link, const Reaction<T>& r) {
  wrenches_[link.i].force += r.force;
  wrenches_[link.j].force -= r.force;
  wrenches_[link.i].moment += r.moment_i;
  wrenches_[link.j].moment += r.moment_j;
}

template <class T>
void Dynamics<T>::add_link_reactions() {
  for (const Link& link : links_)
    add_reaction(link, link_reaction(motions_[link.i], motions_[link.j], link));
}

template <class T>
LinkStrain<T> Dynamics<T>::strain(const Motion<T>& i, const Motion<T>& j, const Link& link) const {
  return strain_by(coordinates_.rotation(), i, j, properties_[link.properties]);
}

template <class T>
Vector<T> Dynamics<T>::stretch(const Motion<T>& i, const Motion<T>& j, const Link& link) const {
  const LinkProperties<T>& properties = properties_[link.properties];
  return is_linearised() ? linearised_stretch(i, j, properties) : link_stretch(i, j, properties);
}

template <class T>
ElementStrain<T> Dynamics<T>::resistance(std::size_t e, const ElementStrain<T>& strain) const {
  const ElementStrain<T>& constants = pressures_[e];
  return {constants.volume * strain.volume, constants.curvature.cwiseProduct(strain.curvature)};
}

template <class T>
LinkPressure<T> Dynamics<T>::pressure_on(const Link& link, const ElementStrain<T>& i,
                                         const ElementStrain<T>& j) const {
  const LinkProperties<T>& properties = properties_[link.properties];
  return pressure_on_link(properties.axis, properties.area, i, j);
}

template <class T>
Reaction<T> Dynamics<T>::pressure_reaction_of(const Motion<T>& i, const Motion<T>& j,
                                              const Link& link,
                                              const LinkPressure<T>& pressure) const {
  return pressure_reaction_by(coordinates_.rotation(), i, j, properties_[link.properties],
                              pressure);
}

template <class T>
std::vector<ElementStrain<T>> Dynamics<T>::link_strains(std::span<const Motion<T>> motions) const {
  std::vector<ElementStrain<T>> strains(pressures_.size());
  for (const Link& link : links_) {
    if (!has_pressure(link)) continue;
    const LinkStrain<T> own = strain(motions[link.i], motions[link.j], link);
    for (const std::size_t e : {link.i, link.j}) add_strain(link, own, strains[e]);
  }
  return strains;
}

template <class T>
void Dynamics<T>::add_load_strains(std::span<const double> signals,
                                   std::span<ElementStrain<T>> strains) const {
  for (std::size_t l = 0; l < loads_.size() && has_pressure(); ++l)
    for (const std::size_t e : loads_[l].elements)
      strains[e].volume += T(signals[3 + l]) * T(loads_[l].face_strain);
}

template <class T>
std::vector<ElementStrain<T>> Dynamics<T>::strains(std::span<const T> state,
                                                   std::span<const double> signals) const {
  if (!has_pressure()) return {};
  std::vector<Motion<T>> motions;
  for (std::size_t e = 0; e < elements_.size(); ++e)
    motions.push_back(placed(e, state.data() + e * field_count));
  std::vector<ElementStrain<T>> all = link_strains(motions);
  if (!signals.empty()) add_load_strains(signals, all);
  return all;
}

template <class T>
void Dynamics<T>::add_pressure_reactions(std::span<const ElementStrain<T>> strains) {
  if (!has_pressure()) return;
  for (const Link& link : links_) {
    if (!has_pressure(link)) continue;
    const LinkPressure<T> pressure =
        pressure_on(link, resistance(link.i, strains[link.i]), resistance(link.j, strains[link.j]));
    add_reaction(link, pressure_reaction_of(motions_[link.i], motions_[link.j], link, pressure));
  }
}

template <class T>
void Dynamics<T>::add_loads(std::span<const double> signals) {
  for (std::size_t l = 0; l < loads_.size(); ++l) {
    const T scale = T(signals[3 + l]);
    const Vector<T> force = scale * vector_of<T>(loads_[l].force);
    const Vector<T> torque = scale * vector_of<T>(loads_[l].torque);
    for (const std::size_t e : loads_[l].elements) {
      wrenches_[e].force += force;
      wrenches_[e].moment += torque;
    }
  }
}

template <class T>
void Dynamics<T>::add_stabilization() {
  if (!stabilization_.is_present()) return;
  const T k = T(stabilization_.k), d = T(stabilization_.d);
  const T k_rot = T(stabilization_.k_rot), d_rot = T(stabilization_.d_rot);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Motion<T>& m = motions_[e];
    wrenches_[e].force -= k * m.u + d * m.v;
    wrenches_[e].moment -= T(2) * k_rot * m.q.v + d_rot * m.w;
  }
}

/// Inertia of a frame with the angular velocity W and its derivative W', at the place x = X + u:
///   force   -m (W' x x + W x (W x x) + 2 W x v)
///   moment  -J (W' + W x w) - [(w + W) x J (w + W) - w x J w]
/// because the velocities against fixed axes are v + W x x and w + W.
template <class T>
void Dynamics<T>::add_frame_wrenches(std::span<const double> signals) {
  if (rest_.empty()) return;
  const double* const of_frame = &signals[3 + loads_.size()];
  const Vector<T> rate = Eigen::Map<const Eigen::Vector3d>(of_frame).template cast<T>(),
                  change = Eigen::Map<const Eigen::Vector3d>(of_frame + 3).template cast<T>();
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const BodyMass body = mass_of(e);
    const Motion<T>& m = motions_[e];
    const Vector<T> x = rest_[e] + m.u, whole = m.w + rate;
    wrenches_[e].force -=
        body.mass * (change.cross(x) + rate.cross(Vector<T>(rate.cross(x) + T(2) * m.v)));
    const Matrix<T> a = body_axes(m), inertia = a * body.inertia.asDiagonal() * a.transpose();
    wrenches_[e].moment -= inertia * (change + rate.cross(m.w)) +
                           whole.cross(Vector<T>(inertia * whole)) -
                           m.w.cross(Vector<T>(inertia * m.w));
  }
}

/// The axes of an element's inertia in the global frame, as columns.
template <class T>
Matrix<T> Dynamics<T>::body_axes(const Motion<T>& motion) const {
  return has_vectors() ? Matrix<T>::Identity() : motion.rotation();
}

/// J^-1 (moment - w x J w) with J = A diag(inertia) A^T. A scalar inertia and the linear equations
/// have no gyroscopic term.
template <class T>
Vector<T> Dynamics<T>::angular_acceleration(const BodyMass& body, const Motion<T>& motion,
                                            const Vector<T>& moment) const {
  if (!body.has_tensor_inertia) return moment / body.inertia.x();
  if (is_linearised()) return moment.cwiseQuotient(body.inertia);
  const Matrix<T> a = body_axes(motion);
  const Vector<T> spin = a * body.inertia.cwiseProduct(a.transpose() * motion.w);
  const Vector<T> net = moment - motion.w.cross(spin);
  return a * Vector<T>(a.transpose() * net).cwiseQuotient(body.inertia);
}

template <class T>
void Dynamics<T>::find_wrenches(std::span<const T> state, std::span<const double> signals) {
  place(state);
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  add_link_reactions();
  if (has_pressure()) {
    std::vector<ElementStrain<T>> strains = link_strains(motions_);
    add_load_strains(signals, strains);
    add_pressure_reactions(strains);
  }
  add_loads(signals);
  add_stabilization();
  add_frame_wrenches(signals);
}

template <class T>
void Dynamics<T>::wrenches(std::span<const T> state, std::span<const double> signals,
                           std::span<T> wrenches) {
  find_wrenches(state, signals);
  const Vector<T> frame{T(signals[0]), T(signals[1]), T(signals[2])};
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Vector<T> force = wrenches_[e].force + mass_of(e).mass * frame;
    for (const int axis : {0, 1, 2}) {
      wrenches[6 * e + std::size_t(axis)] = force[axis];
      wrenches[6 * e + 3 + std::size_t(axis)] = wrenches_[e].moment[axis];
    }
  }
}

template <class T>
void Dynamics<T>::rates(std::span<const T> state, std::span<const double> signals,
                        std::span<T> rates) {
  find_wrenches(state, signals);
  const Vector<T> frame{T(signals[0]), T(signals[1]), T(signals[2])};
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const BodyMass body = mass_of(e);
    const Motion<T>& motion = motions_[e];
    Vector<T> dv = wrenches_[e].force / body.mass + frame;
    Vector<T> dw = angular_acceleration(body, motion, wrenches_[e].moment);
    for (const int axis : {0, 1, 2}) {
      if (elements_[e].clamped & (dof_ux << axis)) dv[axis] = 0;
      if (elements_[e].clamped & (dof_rx << axis)) dw[axis] = 0;
    }
    T* f = rates.data() + e * field_count;
    for (const int axis : {0, 1, 2}) {
      f[ux + axis] = motion.v[axis];
      f[vx + axis] = dv[axis];
      f[wx + axis] = dw[axis];
    }
    const Orientation<T> c = orientation_fields(state.data() + e * field_count);
    set_orientation_fields(f, coordinates_.rate(c, motion.w));
  }
}

/// Mass and inertia of an element.
template <class T>
typename Dynamics<T>::BodyMass Dynamics<T>::mass_of(std::size_t e) const {
  BodyMass own = bodies_[std::size_t(elements_[e].body)];
  own.mass *= elements_[e].mass_ratio;
  own.inertia *= elements_[e].mass_ratio;
  return own;
}

template <class T>
T Dynamics<T>::kinetic_energy_of(std::size_t e) const {
  const BodyMass body = mass_of(e);
  const Motion<T>& m = motions_[e];
  const Vector<T> body_spin = body_axes(m).transpose() * m.w;
  return body.mass * m.v.squaredNorm() / T(2) + body.inertia.dot(body_spin.cwiseAbs2()) / T(2);
}

template <class T>
T Dynamics<T>::kinetic_energy(std::span<const T> state) {
  place(state);
  T energy = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) energy += kinetic_energy_of(e);
  return energy;
}

template <class T>
T Dynamics<T>::energy(std::span<const T> state) {
  place(state);
  const T k = T(stabilization_.k), k_rot = T(stabilization_.k_rot);
  T energy = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Motion<T>& m = motions_[e];
    energy += kinetic_energy_of(e);
    // The stabilization's moment -2 k_rot v derives from -4 k_rot s, because ds/dt = -w.v/2. With
    // |q| = 1, s is a sum of squares.
    energy += k * m.u.squaredNorm() / T(2) + T(2) * k_rot * (m.q.s * m.q.s + m.q.v.squaredNorm());
  }
  for (const Link& link : links_) {
    const Motion<T>&i = motions_[link.i], &j = motions_[link.j];
    const LinkProperties<T>& properties = properties_[link.properties];
    energy +=
        is_linearised() ? linearised_energy(i, j, properties) : elastic_energy(i, j, properties);
  }
  const std::vector<ElementStrain<T>> strains = link_strains(motions_);
  for (std::size_t e = 0; e < strains.size(); ++e) {
    const ElementStrain<T> resists = resistance(e, strains[e]);
    energy += volume(e) / T(2) *
              (resists.volume * strains[e].volume + resists.curvature.dot(strains[e].curvature));
  }
  return energy;
}

template <class T>
T Dynamics<T>::supplied_power(std::span<const T> state, std::span<const double> signals) {
  place(state);
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  add_loads(signals);
  std::vector<ElementStrain<T>> loaded(pressures_.size());
  add_load_strains(signals, loaded);
  add_pressure_reactions(loaded);
  add_frame_wrenches(signals);
  const Vector<T> frame{T(signals[0]), T(signals[1]), T(signals[2])};
  T power = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Vector<T> force = wrenches_[e].force + mass_of(e).mass * frame;
    power += force.dot(motions_[e].v) + wrenches_[e].moment.dot(motions_[e].w);
  }
  return power;
}

/// Both laws are linear in the velocities, so the dampers' part is what changes if the elements
/// stand still.
template <class T>
T Dynamics<T>::dissipated_power(std::span<const T> state) {
  place(state);
  const T d = T(stabilization_.d), d_rot = T(stabilization_.d_rot);
  const auto power_of = [](const Reaction<T>& r, const Motion<T>& i, const Motion<T>& j) {
    return r.force.dot(j.v - i.v) - r.moment_i.dot(i.w) - r.moment_j.dot(j.w);
  };
  T power = 0;
  for (const Motion<T>& m : motions_) power += d * m.v.squaredNorm() + d_rot * m.w.squaredNorm();
  for (const Link& link : links_) {
    const Motion<T>&i = motions_[link.i], &j = motions_[link.j];
    Motion<T> still_i = i, still_j = j;
    still_i.v.setZero(), still_i.w.setZero(), still_j.v.setZero(), still_j.w.setZero();
    power += power_of(link_reaction(i, j, link), i, j) -
             power_of(link_reaction(still_i, still_j, link), i, j);
  }
  return power;
}

template <class T>
std::size_t Dynamics<T>::bytes() const {
  return elements_.size() * (sizeof(Element) + sizeof(Motion<T>) + sizeof(Wrench)) +
         links_.size() * sizeof(Link) + properties_.size() * sizeof(LinkProperties<T>) +
         pressures_.size() * sizeof(pressures_[0]) + rest_.size() * sizeof(Vector<T>) +
         coordinates_.bytes();
}

#define DSS_INSTANTIATE(T)                                                                         \
  template class Dynamics<T>;                                                                      \
  template Motion<T> motion_of(const T*);
DSS_EACH_REAL(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::reference
