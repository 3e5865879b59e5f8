#include "solver/model/sufficiency/sufficiency.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dss {
namespace {

/// First component out of the plane, or an empty text. That is z of a vector, x or y of an axial
/// vector.
std::string out_of_plane(const Vec3& v, const char* what, const char* unit, bool is_axial) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axis == 2) != is_axial && v[axis] != 0)
      return fmt::format("{} {} = {} {}", what, "xyz"[axis], v[axis], unit);
  return {};
}

std::string load_leaves_plane(const Problem& problem) {
  for (std::size_t l = 0; l < problem.loads.size(); ++l) {
    const Load& load = problem.loads[l];
    if (is_zero_always(load.signal)) continue;
    for (const std::string& item : {out_of_plane(load.force, "force", "N", false),
                                    out_of_plane(load.torque, "torque", "N m", true)})
      if (!item.empty()) return fmt::format("load {} leaves the plane: {}", l, item);
  }
  if (!is_zero_always(problem.frame_acceleration[2]))
    return "gravity or base acceleration acts along z";
  return {};
}

std::string start_leaves_plane(const Problem& problem) {
  for (std::size_t m = 0; m < problem.initial_motions.size(); ++m) {
    const InitialMotion& motion = problem.initial_motions[m];
    for (const std::string& item :
         {out_of_plane(motion.displacement, "displacement", "m", false),
          out_of_plane(motion.rotation, "rotation", "rad", true),
          out_of_plane(motion.velocity, "velocity", "m/s", false),
          out_of_plane(motion.angular_velocity, "angular velocity", "rad/s", true)})
      if (!item.empty()) return fmt::format("initial motion {} leaves the plane: {}", m, item);
  }
  return {};
}

} // namespace

// Clamps need no check. A clamp out of the plane holds something that does not move. A clamp in the
// plane is part of the planar model.
std::string why_not_planar(const Problem& problem) {
  for (const auto& leaves : {thickness_in_z, load_leaves_plane, start_leaves_plane})
    if (std::string reason = leaves(problem); !reason.empty()) return reason;
  return {};
}

} // namespace dss
