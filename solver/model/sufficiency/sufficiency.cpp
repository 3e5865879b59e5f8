#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <stdexcept>

namespace dss {
namespace {

const char* unit_of(Field field) {
  if (field <= uz) return " m";
  if (field <= vz) return " m/s";
  return field <= qz ? "" : " rad/s";
}

} // namespace

std::string start_with(const Problem& problem, std::initializer_list<Field> fields) {
  constexpr std::size_t piece = 4096;
  std::vector<double> state(piece * field_count);
  if (problem.initial_motions.empty()) return {};
  for (std::size_t first = 0; first < problem.lattice.element_count; first += piece) {
    const std::size_t count = std::min(piece, problem.lattice.element_count - first);
    initial_state(problem, first, count, state.data());
    for (std::size_t e = 0; e < count; ++e)
      for (const Field field : fields)
        if (const double value = state[e * field_count + std::size_t(field)]; value != 0)
          return fmt::format("element {} starts with {} = {:g}{}", first + e,
                             field_names[std::size_t(field)], value, unit_of(field));
  }
  return {};
}

std::string load_along(const Problem& problem, std::initializer_list<int> forces,
                       std::initializer_list<int> torques) {
  for (std::size_t l = 0; l < problem.loads.size(); ++l) {
    const Load& load = problem.loads[l];
    if (is_zero_always(load.signal)) continue;
    for (const int axis : forces)
      if (const double force = load.force[std::size_t(axis)]; force != 0)
        return fmt::format("load {} has force {} = {:g} N", l, "xyz"[axis], force);
    for (const int axis : torques)
      if (const double torque = load.torque[std::size_t(axis)]; torque != 0)
        return fmt::format("load {} has torque {} = {:g} N m", l, "xyz"[axis], torque);
  }
  return {};
}

std::string acceleration_along(const Problem& problem, std::initializer_list<int> axes) {
  for (const int axis : axes)
    if (!is_zero_always(problem.frame_acceleration[std::size_t(axis)]))
      return fmt::format("gravity or base acceleration acts along {}", "xyz"[axis]);
  return {};
}

std::string pressed_faces(const Problem& problem) {
  for (std::size_t l = 0; l < problem.loads.size() && problem.has_pressure(); ++l)
    if (problem.loads[l].face_strain != 0 && !is_zero_always(problem.loads[l].signal))
      return fmt::format("load {} presses on faces, and the body gets wider", l);
  return {};
}

std::string why_not_in_translation(const Problem& problem) {
  if (!problem.clamps.empty())
    return fmt::format("element {} is clamped, and others move", problem.clamps[0].element);
  if (std::string reason = load_along(problem, {}, {0, 1, 2}); !reason.empty()) return reason;
  if (std::string reason = start_with(problem, {qs, qx, qy, qz, wx, wy, wz}); !reason.empty())
    return reason;
  if (std::string reason = pressed_faces(problem); !reason.empty()) return reason;
  const std::size_t count = problem.lattice.element_count;
  for (std::size_t l = 0; l < problem.loads.size(); ++l) {
    const Load& load = problem.loads[l];
    if (is_zero_always(load.signal) || load.force == Vec3{}) continue;
    if (load.elements.size() != count)
      return fmt::format("load {} pulls some elements and not others", l);
  }
  const bool has_one_mass =
      !problem.has_mass_ratios() && std::ranges::all_of(problem.bodies, [&](const Body& body) {
        return body.mass == problem.bodies.front().mass;
      });
  const bool is_pulled =
      std::ranges::any_of(problem.loads, [](const Load& load) { return load.force != Vec3{}; });
  if (!has_one_mass && (is_pulled || problem.stabilization.is_present()))
    return "bodies of different elements are accelerated differently by the same force";
  const std::vector<double> state = initial_state(problem);
  for (std::size_t e = 1; e < count; ++e)
    if (!std::equal(state.begin(), state.begin() + qs,
                    state.begin() + std::ptrdiff_t(e * field_count)))
      return fmt::format("element {} starts otherwise than element 0", e);
  return {};
}

std::string why_not(Model model, const Problem& problem) {
  if (model != Model::spatial && problem.has_rotating_frame()) return "its frame rotates";
  if (model != Model::spatial && problem.has_mass_ratios())
    return "its elements differ in mass, because its materials have different densities";
  return why_no_degrees(model, problem);
}

std::string why_no_degrees(Model model, const Problem& problem) {
  switch (degrees_of(model)) {
  case dof_all:
    return {};
  case dof_ux:
    return why_not_axial(problem);
  case dof_uz | dof_rx | dof_ry:
    return why_not_bending(problem);
  case dof_ux | dof_uy | dof_rz:
    return why_not_planar(problem);
  }
  throw std::logic_error("sufficiency.cpp: no proof for these degrees of freedom");
}

std::string why_not_exact(Model model, const Problem& problem) {
  if (std::string reason = why_not(model, problem); !reason.empty()) return reason;
  if (has_rotation_vectors(model))
    if (const std::string reason = why_not_in_translation(problem); !reason.empty())
      return "small rotations are assumed, and nothing proves that there are none: " + reason;
  return {};
}

Model smallest_exact(const Problem& problem) {
  return *std::ranges::find_if(models,
                               [&](Model model) { return why_not_exact(model, problem).empty(); });
}

} // namespace dss
