#pragma once
/// A problem: everything to compute, with every number resolved, in SI units. A scene produces it;
/// every variant and the oracle take it. Nothing here depends on how or where it is computed.
#include "kernels/fields.hpp"
#include "solver/lattice/lattice.hpp"
#include "solver/model/signal.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dss {

/// Link laws of DESIGN.md section 2.
enum class LinkLaw { paper, material };

/// Constants of a link across the faces normal to one body axis.
/// Rotational constants are about the body's x, y, z axes. For a link along x, k_rot[0] is the
/// twist and the others bend.
/// Shear constants are those of gaps along the body's x, y, z axes. That of the link's own axis is
/// 0.
/// The paper's law is isotropic: k_normal > 0 equals k_shear, d_normal equals d_shear, all k_rot
/// are equal, all d_rot are equal, and links are the same on all axes.
struct AxisConstants {
  double k_normal = 0, d_normal = 0; ///< [N/m], [N s/m]
  Vec3 k_shear{}, d_shear{};         ///< [N/m], [N s/m]
  Vec3 k_rot{}, d_rot{};             ///< [N m/rad], [N m s/rad]
  bool is_damped() const { return d_normal != 0 || d_shear != Vec3{} || d_rot != Vec3{}; }
  bool operator==(const AxisConstants&) const = default;
};

/// The same shear constant across a link along `axis`.
constexpr Vec3 across(int axis, double shear) {
  Vec3 both{shear, shear, shear};
  both[std::size_t(axis)] = 0;
  return both;
}

/// Axes across a link, as the material law tells them apart (kernels/link_force/link_force.h).
struct ShearAxes {
  std::size_t base, third;
};
constexpr ShearAxes shear_axes(int axis) { return {axis == 1 ? 0U : 1U, axis == 2 ? 0U : 2U}; }

/// How an element of a solid resists a change of its volume, and a thin one the sum of its
/// curvatures. It couples all links of the element (solver/reference/pressure.hpp has the
/// equation).
struct ElementPressure {
  double volume = 0; ///< [Pa]
  /// About the normal of a plate that is one layer thick along x, y or z [N]; else 0.
  Vec3 bending{};
  bool operator==(const ElementPressure&) const = default;
};

/// A body of identical box elements. Its elements are those of the lattice rows whose `body` is its
/// index.
struct Body {
  std::string name;
  LinkLaw law = LinkLaw::paper;
  bool has_links_of_beams = false; ///< each link is a beam of a material (softness_notes)
  Vec3 edge{};                     ///< edge lengths of an element [m]
  Vec3 origin{};                   ///< rest position of the low corner of cell (0, 0, 0) [m]
  double mass = 0;                 ///< of one element [kg]
  /// Of a body of several materials, by their numbers: mass of an element over `mass`, which holds
  /// for its inertia as well. Else empty.
  std::vector<double> mass_ratios;
  Vec3 inertia{}; ///< principal moments of one element about its body axes [kg m^2]
  std::array<AxisConstants, 3> axis{}; ///< constants of links along x, y, z: of the kind 0
  /// Of the kinds 1, 2, ... on each axis, if links differ (Problem::link_kinds).
  std::vector<std::array<AxisConstants, 3>> more_kinds;
  /// The kinds of its elements, if their pressure counts (Problem::pressure_kinds); else empty.
  std::vector<ElementPressure> pressures;
  std::size_t kinds() const { return 1 + more_kinds.size(); }
  const AxisConstants& link(int along, std::size_t kind) const {
    return (kind == 0 ? axis : more_kinds[kind - 1])[std::size_t(along)];
  }
  /// Calls visit(constants, axis) for each kind of link.
  template <class Visit>
  void each_kind(Visit&& visit) const {
    for (std::size_t kind = 0; kind < kinds(); ++kind)
      for (const int along : {0, 1, 2}) visit(link(along, kind), along);
  }
  bool has_tensor_inertia() const { return inertia[0] != inertia[1] || inertia[1] != inertia[2]; }
};

/// Clamped degrees of freedom. Their accelerations and initial velocities are zero.
struct Clamp {
  std::size_t element = 0;
  std::uint8_t dofs = 0; ///< bits of Dof
  /// Those of them that clamps hold at faces -x, +x, -y, +y, -z, +z by selecting these faces. The
  /// others are held at any face without neighbour.
  std::array<std::uint8_t, 6> at_faces{};
};

/// The same wrench on each of some elements, scaled by a signal. It is in global axes and does not
/// follow rotation.
struct Load {
  std::vector<std::size_t> elements; ///< ascending
  Vec3 force{}, torque{};            ///< on each element [N], [N m], at signal value 1
  Signal signal;
  /// What the force adds to the volume strain of each element, at signal value 1, if it is the
  /// traction t of a free face with the normal n at rest: n.t / 4G.
  double face_strain = 0;
  /// Number of the face that it acts on: 2 axis, + 1 if an upper one. -1: on the volume.
  int face = -1;
};

/// A link outside the grid, between the upper (+axis) face of element i and the lower (-axis) face
/// of element j. It is unstrained at rest, wherever the two elements are. Its arms are half edges
/// of each element's own body. The laws are as in Body.
struct ExtraLink {
  std::size_t i = 0, j = 0;
  int axis = 0;
  LinkLaw law = LinkLaw::paper;
  AxisConstants constants;
};

/// Weak springs and dampers that tie every element to the frame: force -k u - d v, moment -k_rot 2
/// (qx, qy, qz) - d_rot w.
struct Stabilization {
  double k = 0, d = 0, k_rot = 0, d_rot = 0;
  bool is_present() const { return k != 0 || d != 0 || k_rot != 0 || d_rot != 0; }
};

/// Initial motion of a set of elements, rigid or uniform.
struct InitialMotion {
  std::vector<std::size_t> elements;
  /// [m]; rotation vector [rad] of each element about its own centre
  Vec3 displacement{}, rotation{};
  Vec3 velocity{}, angular_velocity{}; ///< [m/s], [rad/s]
  /// True: the set also turns about `centre` as one rigid body; u and v get the rigid field.
  bool is_rigid = false;
  Vec3 centre{}; ///< [m]
};

/// Tolerances of a scene for one precision: relative errors after one evaluation of the right-hand
/// side, and after the run.
struct Tolerance {
  double evaluation = 0, run = 0;
};

/// Why a variant does not compute a problem in a rotating frame.
inline constexpr const char* rotation_is_missing = "has no frame that rotates (\"base_rotation\")";
/// Why a variant does not compute a problem whose elements differ in mass.
inline constexpr const char* mass_ratios_are_missing =
    "has no bodies of several materials with different densities";
/// Why a variant does not compute a problem whose elements have a pressure.
inline constexpr const char* pressure_is_missing =
    "has no law \"solid\" with nu > 0, whose elements have a pressure";

/// A problem to compute. Element numbers are those of the lattice.
struct Problem {
  std::string name; ///< name of the scene
  Lattice lattice;
  std::vector<Body> bodies;
  /// For each element the kinds of its links to the upper neighbours along x, y, z. Empty if all
  /// are 0.
  std::vector<std::array<std::uint8_t, 3>> link_kinds;
  /// For each element its kind in Body::pressures. Empty if no body has any.
  std::vector<std::uint8_t> pressure_kinds;
  /// For each element the number of its material, 1 to 255. Empty if all are 1.
  std::vector<std::uint8_t> materials;
  std::vector<Clamp> clamps; ///< ascending by element, at most one for each
  std::vector<Load> loads;
  std::vector<ExtraLink> extra_links;
  /// True in a part of a larger problem if some extra link of the whole problem is damped.
  bool has_damped_links_elsewhere = false;
  Stabilization stabilization;
  /// Uniform acceleration of every element: gravity minus the frame's a(t) [m/s^2].
  /// If the frame rotates, along fixed axes, which the frame's are where its rotation is 0.
  std::array<Signal, 3> frame_acceleration;
  /// Rotation vector of the frame about its origin, along fixed axes [rad]
  /// (solver/model/frame.hpp). Its signals are 0, or have derivatives (motion_of).
  std::array<Signal, 3> frame_rotation{no_signal(), no_signal(), no_signal()};
  std::vector<InitialMotion> initial_motions;
  double dt = 0;          ///< default step [s]
  long steps = 0;         ///< default number of steps
  std::string integrator; ///< default method
  Tolerance tolerance_f64, tolerance_f32;

  std::size_t link_count() const { return lattice.link_count() + extra_links.size(); }
  /// Kind of the link from an element to its upper neighbour.
  std::size_t link_kind(std::size_t element, int axis) const {
    return link_kinds.empty() ? 0 : link_kinds[element][std::size_t(axis)];
  }
  /// Calls visit(signal) for every signal that drives the problem.
  template <class Visit>
  void each_signal(Visit&& visit) const {
    for (const Load& load : loads) visit(load.signal);
    for (const auto* of_frame : {&frame_acceleration, &frame_rotation})
      for (const Signal& signal : *of_frame) visit(signal);
  }
  int material(std::size_t element) const { return materials.empty() ? 1 : materials[element]; }
  /// Mass of an element over that of its body. @param body  the element's own
  double mass_ratio(std::size_t element, const Body& body) const {
    return body.mass_ratios.empty() ? 1 : body.mass_ratios[std::size_t(material(element))];
  }
  double mass(std::size_t element, const Body& body) const {
    return body.mass * mass_ratio(element, body);
  }
  /// Whether elements of some body differ in mass.
  bool has_mass_ratios() const {
    return std::ranges::any_of(bodies, [](const Body& body) { return !body.mass_ratios.empty(); });
  }
  bool has_pressure() const { return !pressure_kinds.empty(); }
  bool has_rotating_frame() const { return !std::ranges::all_of(frame_rotation, is_zero_always); }
  /// @param body  the element's own
  ElementPressure pressure(std::size_t element, const Body& body) const {
    return body.pressures.empty() ? ElementPressure{} : body.pressures[pressure_kinds[element]];
  }
};

/// Fields of the elements [first, first + count) at t = 0.
/// @param fields  output, count * field_count numbers
void initial_state(const Problem& problem, std::size_t first, std::size_t count, double* fields);
/// Fields of all elements at t = 0: element_count * field_count numbers.
std::vector<double> initial_state(const Problem& problem);

/// Shortest edge of all bodies [m].
double shortest_edge(const Problem& problem);

/// Rest position of the centre of cell (x, row.y, row.z) [m].
Vec3 rest_position(const Problem& problem, const Row& row, int x);

/// Returns an empty text if all series of files last until a time [s]. Otherwise returns one line
/// that says which does not.
std::string why_series_too_short(const Problem& problem, double end);
/// Digest of the tables of all signals, 16 hexadecimal digits. They may come from files, which the
/// text of a scene does not hold.
std::string series_digest(const Problem& problem);

/// Returns an empty text if the planar model is exact for the problem: one element thick, and
/// clamps, loads, acceleration and initial state symmetric about the plane z = const. Otherwise
/// returns one line that says what leaves the plane.
std::string why_not_planar(const Problem& problem);

} // namespace dss
