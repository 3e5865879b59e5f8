#pragma once
/// A problem: everything to compute, with every number resolved, in SI units. A scene produces it;
/// every variant and the oracle take it. Nothing here depends on how or where it is computed.
#include "kernels/fields.hpp"
#include "solver/lattice/lattice.hpp"
#include "solver/model/signal.hpp"

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
/// The paper's law is isotropic: k_normal == k_shear > 0, d_normal == d_shear, all k_rot equal, all
/// d_rot equal, and the same on all axes.
struct AxisConstants {
  double k_normal = 0, k_shear = 0; ///< [N/m]
  double d_normal = 0, d_shear = 0; ///< [N s/m]
  Vec3 k_rot{}, d_rot{};            ///< [N m/rad], [N m s/rad]
  bool is_damped() const { return d_normal != 0 || d_shear != 0 || d_rot != Vec3{}; }
};

/// A body of identical box elements. Its elements are those of the lattice rows whose `body` is its
/// index.
struct Body {
  std::string name;
  LinkLaw law = LinkLaw::paper;
  Vec3 edge{};     ///< edge lengths of an element [m]
  Vec3 origin{};   ///< rest position of the low corner of cell (0, 0, 0) [m]
  double mass = 0; ///< of one element [kg]
  Vec3 inertia{};  ///< principal moments of one element about its body axes [kg m^2]
  std::array<AxisConstants, 3> axis{}; ///< link constants along x, y, z
  bool has_tensor_inertia() const { return inertia[0] != inertia[1] || inertia[1] != inertia[2]; }
};

/// Clamped degrees of freedom. Their accelerations and initial velocities are zero.
struct Clamp {
  std::size_t element = 0;
  std::uint8_t dofs = 0; ///< bits of Dof
};

/// The same wrench on each of some elements, scaled by a signal. It is in global axes and does not
/// follow rotation.
struct Load {
  std::vector<std::size_t> elements; ///< ascending
  Vec3 force{}, torque{};            ///< on each element [N], [N m], at signal value 1
  Signal signal;
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

/// A problem to compute. Element numbers are those of the lattice.
struct Problem {
  std::string name; ///< name of the scene
  Lattice lattice;
  std::vector<Body> bodies;
  std::vector<Clamp> clamps; ///< ascending by element, at most one for each
  std::vector<Load> loads;
  std::vector<ExtraLink> extra_links;
  /// True in a part of a larger problem if some extra link of the whole problem is damped.
  bool has_damped_links_elsewhere = false;
  Stabilization stabilization;
  /// Uniform acceleration of every element: gravity minus the frame's a(t) [m/s^2].
  std::array<Signal, 3> frame_acceleration;
  std::vector<InitialMotion> initial_motions;
  double dt = 0;          ///< default step [s]
  long steps = 0;         ///< default number of steps
  std::string integrator; ///< default method
  Tolerance tolerance_f64, tolerance_f32;

  std::size_t link_count() const { return lattice.link_count() + extra_links.size(); }
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

/// Returns an empty text if the planar model is exact for the problem: one element thick, and
/// clamps, loads, acceleration and initial state symmetric about the plane z = const. Otherwise
/// returns one line that says what leaves the plane.
std::string why_not_planar(const Problem& problem);

} // namespace dss
