#include "solver/model/sufficiency/sufficiency.hpp"

#include <fmt/format.h>

namespace dss {

std::string thickness_in_z(const Problem& problem) {
  const std::vector<Row>& rows = problem.lattice.rows;
  for (std::size_t r = 1; r < rows.size(); ++r)
    if (rows[r].body == rows[r - 1].body && rows[r].z != rows[r - 1].z)
      return fmt::format("body \"{}\" is more than one element thick in z",
                         problem.bodies[std::size_t(rows[r].body)].name);
  for (std::size_t l = 0; l < problem.extra_links.size(); ++l)
    if (const ExtraLink& link = problem.extra_links[l]; link.axis == 2)
      return fmt::format("extra link {} between elements {} and {} is along z", l, link.i, link.j);
  return {};
}

// Across the face of a link along x or y the arm lies in the plane: by it rx and ry move face points along z, rz within the plane; forces along z have
// moments about x and y, forces within the plane about z; constants are the same about and along the global axes for all time. An arm along z would make
// rx and ry slide faces within the plane. Clamps hold single degrees of freedom, and so do ties; nothing else joins the two halves.
std::string why_not_bending(const Problem& problem) {
  for (const std::string& reason : {thickness_in_z(problem), load_along(problem, {0, 1}, {2}),
                                    acceleration_along(problem, {0, 1}), start_with(problem, {ux, uy, vx, vy, qz, wz})})
    if (!reason.empty()) return reason;
  return {};
}

} // namespace dss
