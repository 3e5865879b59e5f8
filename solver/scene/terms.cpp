#include "solver/scene/terms.hpp"

#include "solver/scene/constants.hpp"
#include "solver/scene/selection.hpp"
#include "solver/scene/signals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dss {
namespace {

const std::vector<std::string> axis_names = {"x", "y", "z"};

/// One side of a joint: elements of a body, by face or listed.
struct JointSide {
  int body = 0;
  std::vector<std::size_t> elements;
  std::optional<std::size_t> face; ///< index of face_names
};

JointSide read_joint_side(const Node& node, const Problem& problem, const BodySurfaces& surfaces) {
  ObjectNode object(node);
  JointSide side;
  side.body = read_body(object, problem);
  side.elements = read_selection(object, problem, side.body, surfaces);
  if (const auto face = object.find("face")) side.face = face->choice("face", face_names);
  object.finish();
  return side;
}

/// Axis of a joint from upper (+) faces of one side to lower (-) faces of the other.
int joint_axis(ObjectNode& joint, const JointSide& from, const JointSide& to) {
  const auto axis_node = joint.find("axis");
  if (!axis_node && !from.face && !to.face) joint.fail("\"axis\" is missing; it is x, y or z");
  const std::size_t axis =
      axis_node ? axis_node->choice("axis", axis_names) : (from.face ? *from.face : *to.face) / 2;
  if (from.face && *from.face != 2 * axis + 1)
    joint.fail(fmt::format("a link along {} starts from face {} of \"from\", not {}",
                           axis_names[axis], face_names[2 * axis + 1], face_names[*from.face]));
  if (to.face && *to.face != 2 * axis)
    joint.fail(fmt::format("a link along {} ends at face {} of \"to\", not {}", axis_names[axis],
                           face_names[2 * axis], face_names[*to.face]));
  return int(axis);
}

/// A body whose elements have the mass of one of them.
Body body_of_element(const Problem& problem, const Body& body, std::size_t element) {
  Body own;
  own.edge = body.edge;
  const double ratio = problem.mass_ratio(element, body);
  own.mass = ratio * body.mass;
  for (std::size_t a = 0; a < 3; ++a) own.inertia[a] = ratio * body.inertia[a];
  return own;
}

std::uint8_t read_dofs(const Node& node) {
  static const std::vector<std::string> names(dof_names.begin(), dof_names.end());
  if (node.is_string()) {
    if (node.text() != "all")
      node.fail(fmt::format("{} is neither \"all\" nor a list of {}", node.shown(), listed(names)));
    return dof_all;
  }
  unsigned dofs = 0;
  for (const Node& item : node.items()) dofs |= 1U << item.choice("degree of freedom", names);
  if (dofs == 0) node.fail("clamps nothing; list some of " + listed(names) + ", or write \"all\"");
  return std::uint8_t(dofs);
}

Vec3 mean_position(const Problem& problem, const std::vector<std::size_t>& elements) {
  Vec3 mean{};
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    if (!std::binary_search(elements.begin(), elements.end(), element)) return;
    const Vec3 place = rest_position(problem, row, x);
    for (std::size_t a = 0; a < 3; ++a) mean[a] += place[a] / double(elements.size());
  });
  return mean;
}

InitialMotion read_initial_motion(const Node& node, const Problem& problem,
                                  const BodySurfaces& surfaces) {
  ObjectNode object(node);
  InitialMotion motion;
  motion.elements = read_selected(object, problem, surfaces, true);
  motion.displacement = object.vector_or("displacement", {});
  motion.rotation = object.vector_or("rotation", {});
  motion.velocity = object.vector_or("velocity", {});
  motion.angular_velocity = object.vector_or("angular_velocity", {});
  const auto centre = object.find("centre");
  motion.is_rigid = object.flag_or("rigid", false);
  if (centre && !motion.is_rigid)
    centre->fail("only a rigid motion has a centre; add \"rigid\": true");
  if (motion.is_rigid)
    motion.centre = centre ? centre->vector() : mean_position(problem, motion.elements);
  object.finish();
  return motion;
}

/// Returns why a clamp cannot hold its degrees of freedom exactly, or an empty text.
/// @param fields  fields of the element at t = 0
std::string clamp_conflict(const Clamp& clamp, const Body& body, const double* fields) {
  constexpr const char* names = "xyz";
  const int held =
      ((clamp.dofs & dof_rx) != 0) + ((clamp.dofs & dof_ry) != 0) + ((clamp.dofs & dof_rz) != 0);
  if (body.has_tensor_inertia() && held == 1)
    return "has one of its rotations clamped; as its inertia is a tensor, which couples them, "
           "clamp two, three or none";
  for (int a = 0; a < 3; ++a) {
    if ((clamp.dofs & (dof_ux << a)) != 0 && fields[vx + a] != 0)
      return fmt::format("is clamped in u{} but starts with a velocity of {} m/s; it must be 0",
                         names[a], fields[vx + a]);
    if ((clamp.dofs & (dof_rx << a)) == 0) continue;
    if (fields[wx + a] != 0)
      return fmt::format(
          "is clamped in r{} but starts with an angular velocity of {} rad/s; it must be 0",
          names[a], fields[wx + a]);
    if (body.has_tensor_inertia() && held == 2 && fields[qx + a] != 0)
      return fmt::format("has two of its rotations clamped and starts turned about {}; as its "
                         "inertia is a tensor, turn "
                         "it about its free axis only, or clamp all",
                         names[a]);
  }
  return {};
}

} // namespace

void read_extra_links(const Node& node, const BodySurfaces& surfaces, Problem& problem,
                      Solids& solids) {
  for (const Node& item : node.items()) {
    ObjectNode joint(item);
    const JointSide from = read_joint_side(joint.require("from"), problem, surfaces);
    const JointSide to = read_joint_side(joint.require("to"), problem, surfaces);
    if (from.elements.size() != to.elements.size())
      joint.fail(fmt::format(
          "joins {} elements to {}; the two sides are paired in order and need equal numbers",
          from.elements.size(), to.elements.size()));
    ExtraLink link;
    link.axis = joint_axis(joint, from, to);
    const Body &body_from = problem.bodies[std::size_t(from.body)],
               &body_to = problem.bodies[std::size_t(to.body)];
    std::optional<Material> solid;
    const BodyMaterials& own = solids.bodies[std::size_t(from.body)];
    const auto constants = joint.find("constants");
    const bool has_own = !constants && own.is_solid(),
               has_ratios = !body_from.mass_ratios.empty() || !body_to.mass_ratios.empty();
    if (constants) {
      solid = read_link_constants(*constants, body_from, body_to, link);
    } else {
      link.law = body_from.law;
      link.constants = body_from.axis[std::size_t(link.axis)];
    }
    joint.finish();
    for (std::size_t k = 0; k < from.elements.size(); ++k) {
      link.i = from.elements[k];
      link.j = to.elements[k];
      if (link.i == link.j) joint.fail(fmt::format("joins element {} to itself", link.i));
      if (constants && has_ratios) // dampers follow from masses
        solid = read_link_constants(*constants, body_of_element(problem, body_from, link.i),
                                    body_of_element(problem, body_to, link.j), link);
      if (has_own) solid = own.of(problem.material(link.i));
      if (solid) solid->nu = 0; // pressure does not pass a joint
      if (solid) solids.extra_links.emplace(problem.extra_links.size(), *solid);
      problem.extra_links.push_back(link);
    }
  }
}

void read_clamps(const Node& node, const BodySurfaces& surfaces, Problem& problem) {
  std::vector<Clamp> held(problem.lattice.element_count);
  for (const Node& item : node.items()) {
    ObjectNode object(item);
    const std::vector<std::size_t> elements = read_selected(object, problem, surfaces, false);
    const auto dofs_node = object.find("dofs");
    const std::uint8_t dofs = dofs_node ? read_dofs(*dofs_node) : std::uint8_t(dof_all);
    object.finish();
    const auto face = selected_face(object);
    for (const std::size_t element : elements) {
      held[element].dofs |= dofs;
      if (face) held[element].at_faces[*face] |= dofs;
    }
  }
  for (std::size_t element = 0; element < held.size(); ++element)
    if (const Clamp& clamp = held[element]; clamp.dofs != 0)
      problem.clamps.push_back({element, clamp.dofs, clamp.at_faces});
}

void read_initial_motions(const Node& node, const BodySurfaces& surfaces, Problem& problem) {
  for (const Node& item : node.items())
    problem.initial_motions.push_back(read_initial_motion(item, problem, surfaces));
}

Stabilization read_stabilization(const Node& node) {
  ObjectNode object(node);
  const Stabilization stabilization = {
      object.non_negative_or("k", 0), object.non_negative_or("d", 0),
      object.non_negative_or("k_rot", 0), object.non_negative_or("d_rot", 0)};
  object.finish();
  return stabilization;
}

std::array<Signal, 3> read_frame_acceleration(const std::optional<Node>& gravity,
                                              const std::optional<Node>& base) {
  std::array<Signal, 3> frame;
  for (Signal& signal : frame) signal.amplitude = 0;
  if (base) {
    ObjectNode object(*base);
    for (std::size_t a = 0; a < 3; ++a) {
      if (const auto node = object.find(axis_names[a])) frame[a] = read_signal(*node, "m/s^2");
      frame[a].amplitude = -frame[a].amplitude;
      frame[a].offset = -frame[a].offset;
    }
    object.finish();
  }
  const Vec3 g = gravity ? gravity->vector() : Vec3{};
  for (std::size_t a = 0; a < 3; ++a) frame[a].offset += g[a];
  return frame;
}

std::array<Signal, 3> read_frame_rotation(const Node& node) {
  std::array<Signal, 3> rotation{no_signal(), no_signal(), no_signal()};
  ObjectNode object(node);
  for (std::size_t a = 0; a < 3; ++a)
    if (const auto signal = object.find(axis_names[a])) rotation[a] = read_smooth_signal(*signal);
  object.finish();
  return rotation;
}

void check_clamps(const Problem& problem, const Node& scene) {
  if (problem.clamps.empty()) return;
  const bool is_at_rest = problem.initial_motions.empty();
  std::vector<double> state(
      is_at_rest ? std::size_t(field_count) : problem.lattice.element_count * field_count, 0.0);
  if (!is_at_rest) initial_state(problem, 0, problem.lattice.element_count, state.data());
  auto clamp = problem.clamps.begin();
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    if (clamp == problem.clamps.end() || clamp->element != element) return;
    const Body& body = problem.bodies[std::size_t(row.body)];
    const std::string conflict = clamp_conflict(
        *clamp++, body, state.data() + (is_at_rest ? 0 : element * std::size_t(field_count)));
    if (!conflict.empty())
      ObjectNode(scene).require("clamps").fail(fmt::format("element [{}, {}, {}] of body \"{}\" {}",
                                                           x, row.y, row.z, body.name, conflict));
  });
}

} // namespace dss
