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

// A link along x or y has its arm in the plane. Through that arm, rx and ry move face points along
// z, and rz moves them within the plane. Forces along z have moments about x and y; forces within
// the plane have moments about z. The constants are the same along and about the global axes at all
// times. So the two halves are independent. (An arm along z would couple them: rx and ry would
// slide faces within the plane.) Clamps and ties hold single degrees of freedom and do not couple
// them either. The pressure of an element acts along links, and its moments are about x and y; both
// are of first order in strains of the same half.
std::string why_not_bending(const Problem& problem) {
  for (const std::string& reason :
       {thickness_in_z(problem), load_along(problem, {0, 1}, {2}),
        acceleration_along(problem, {0, 1}), start_with(problem, {ux, uy, vx, vy, qz, wz}),
        pressed_faces(problem)})
    if (!reason.empty()) return reason;
  return {};
}

} // namespace dss
