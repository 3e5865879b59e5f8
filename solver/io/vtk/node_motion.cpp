#include "solver/io/vtk/node_motion.hpp"

#include "solver/model/element_place.hpp"

namespace dss {

NodeMotion node_motion(const Problem& problem, std::span<const double> state,
                       const ElementNodes& nodes) {
  NodeMotion motion{std::vector<Vec3>(nodes.count()), std::vector<Vec3>(nodes.count())};
  std::vector<int> shares(nodes.count());
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    const Vec3 centre = rest_position(problem, row, x);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      Vec3 arm = problem.bodies[std::size_t(row.body)].edge;
      for (std::size_t a = 0; a < 3; ++a) arm[a] *= (corner >> a & 1) != 0 ? 0.5 : -0.5;
      const std::size_t node = nodes.of(element)[corner];
      const Vec3 moved = displacement_at(&state[element * field_count], arm);
      for (std::size_t a = 0; a < 3; ++a) {
        motion.rest[node][a] = centre[a] + arm[a];
        motion.displacement[node][a] += moved[a];
      }
      ++shares[node];
    }
  });
  for (std::size_t node = 0; node < shares.size(); ++node)
    for (double& component : motion.displacement[node]) component /= shares[node];
  return motion;
}

} // namespace dss
