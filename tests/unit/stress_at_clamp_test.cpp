/// Stress and strain where clamps, loads and joints are.
#include "tests/fixtures/stresses.hpp"

#include <cmath>

namespace dss::test {
namespace {

using fixture::stress_at_rest;

constexpr double clamp_edge = 0.01, clamp_modulus = fixture::solid_mu; // G

Problem bar(int nx, int ny, int nz, double nu) {
  return fixture::contracting_solid(fixture::whole_grid(nx, ny, nz),
                                    {clamp_edge, clamp_edge, clamp_edge}, nu);
}
/// Calls act(element, x, y, z) for all elements.
template <class Act>
void each_element(const Problem& problem, Act&& act) {
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int x) { act(e, x, row.y, row.z); });
}
/// A traction on the faces +x [Pa].
void pull_end(Problem& problem, int nx, double nu, const Vec3& traction) {
  Load load{{}, {}, {}, {}, 0, 1};
  each_element(problem, [&](std::size_t e, int x, int, int) {
    if (x == nx - 1) load.elements.push_back(e);
  });
  const double area = clamp_edge * clamp_edge;
  load.force = {area * traction[0], area * traction[1], area * traction[2]};
  load.torque = {0, -clamp_edge / 2 * load.force[2], clamp_edge / 2 * load.force[1]};
  set_face_strain(fixture::contracting(nu), problem.bodies[0].edge, load);
  problem.loads.push_back(load);
}

TEST(StressAtClamp, is_whole_under_clamps_that_select_no_face) {
  Problem pulled = bar(6, 2, 3, 0);
  pull_end(pulled, 6, 0, {1e3, 0, 0});
  each_element(pulled, [&](std::size_t e, int x, int, int) {
    const std::uint8_t across = dof_uy | dof_uz | dof_rx | dof_ry | dof_rz;
    pulled.clamps.push_back({e, x == 0 ? std::uint8_t(dof_all) : across});
  });
  const StressField field = stress_at_rest(pulled);
  const ElementNodes nodes(pulled.lattice);
  for (const SymmetricTensor& stress : field.at_nodes(nodes))
    EXPECT_LE((matrix_of(stress) - fixture::symmetric(1e3, 0, 0, 0, 0, 0)).norm(), 1e-6);
  for (const ElementStress& element : field.elements())
    EXPECT_NEAR(element.strain[0], 1e3 / (2 * clamp_modulus), 1e-12);
}

TEST(StressAtClamp, of_several_layers_is_that_behind_its_last_one) {
  Problem chain = bar(6, 1, 1, 0);
  pull_end(chain, 6, 0, {1e3, 0, 0});
  for (const std::size_t e : {0, 1}) chain.clamps.push_back({e, dof_all});
  const StressField field = stress_at_rest(chain);
  EXPECT_NEAR(field.of(0).stress[0], 0, 1e-9); // inside of the wall
  for (std::size_t e = 1; e < 6; ++e) EXPECT_NEAR(field.of(e).stress[0], 1e3, 1e-7) << e;
}

/// Half of a bar by its plane of symmetry. With nu > 0 the pressure takes the held face for a free
/// one.
TEST(StressAtClamp, is_without_shear_at_a_plane_of_symmetry) {
  Problem pulled = bar(5, 3, 2, 0);
  pull_end(pulled, 5, 0, {1e3, 0, 0});
  each_element(pulled, [&](std::size_t e, int x, int y, int z) {
    const std::uint8_t held = dof_ux | dof_ry | dof_rz;
    if (x == 0)
      pulled.clamps.push_back({e, y == 0 && z == 0 ? std::uint8_t(dof_all) : held, {held}});
  });
  const StressField field = stress_at_rest(pulled);
  for (const ElementStress& element : field.elements())
    EXPECT_LE((matrix_of(element.stress) - fixture::symmetric(1e3, 0, 0, 0, 0, 0)).norm(), 1e-6);
}

TEST(StressAtClamp, has_the_shear_of_a_cantilever_in_every_column) {
  for (const double nu : {0.0, 0.3})
    for (const int layers : {2, 4, 8}) {
      const int nx = 2 * layers;
      Problem beam = bar(nx, layers, 1, nu);
      pull_end(beam, nx, nu, {0, 2.5e3, 0});
      each_element(beam, [&](std::size_t e, int x, int, int) {
        if (x == 0) beam.clamps.push_back({e, dof_all, {dof_all}});
      });
      const StressField field = stress_at_rest(beam, dof_ux | dof_uy | dof_rz);
      std::vector<double> stress(std::size_t(nx), 0), strain(stress);
      each_element(beam, [&](std::size_t e, int x, int, int) {
        stress[std::size_t(x)] += field.of(e).stress[5] / layers;
        strain[std::size_t(x)] += field.of(e).strain[5] / layers;
      });
      for (std::size_t x = 0; x < stress.size(); ++x) {
        EXPECT_NEAR(stress[x] / 2.5e3, 1, 1e-6) << nu << ' ' << layers << ' ' << x;
        EXPECT_NEAR(2 * clamp_modulus * strain[x] / 2.5e3, 1, 0.03)
            << nu << ' ' << layers << ' ' << x;
      }
    }
}

// A chain behind a block: its links have E where those of the block have 2G.
TEST(StressAtClamp, has_strains_by_the_links_of_its_own_elements) {
  VoxelGrid grid = fixture::whole_grid(6, 3, 3);
  for (int c = 0; c < 54; ++c)
    if (c % 6 >= 3 && c != 4 * 6 + c % 6) grid.occupied[std::size_t(c)] = 0;
  constexpr double nu = 0.3;
  Problem stepped = fixture::contracting_solid(grid, {clamp_edge, clamp_edge, clamp_edge}, nu);
  pull_end(stepped, 6, nu, {1e3, 0, 0});
  each_element(stepped, [&](std::size_t e, int x, int, int) {
    if (x == 0) stepped.clamps.push_back({e, dof_all, {dof_all}});
  });
  const StressField field = stress_at_rest(stepped);
  each_element(stepped, [&](std::size_t e, int x, int, int) {
    if (x < 4) return;
    EXPECT_NEAR(field.of(e).stress[0], 1e3, 1e-6) << x;
    EXPECT_NEAR(2 * clamp_modulus * (1 + nu) * field.of(e).strain[0], 1e3, 1e-6) << x;
  });
}

// The joint is a hundred times softer than the chains.
TEST(StressAtClamp, has_no_strain_of_joints) {
  Problem joined = bar(4, 1, 1, 0);
  Body second = joined.bodies[0];
  second.name = "second", second.origin = {4 * clamp_edge, 0, 0};
  append_body(joined.lattice, fixture::whole_grid(4, 1, 1), 1);
  joined.bodies.push_back(second);
  ExtraLink joint{3, 4, 0, LinkLaw::material, joined.bodies[0].axis[0]};
  joint.constants.k_normal /= 100;
  joined.extra_links = {joint};
  pull_end(joined, 4, 0, {1e3, 0, 0});
  joined.loads[0].elements = {7};
  joined.clamps = {{0, dof_all, {dof_all}}};
  const StressField field = stress_at_rest(joined);
  for (std::size_t e = 0; e < 8; ++e) {
    EXPECT_NEAR(field.of(e).stress[0], 1e3, 1e-6) << e;
    EXPECT_NEAR(2 * clamp_modulus * field.of(e).strain[0], 1e3, 1e-6) << e;
  }
}

} // namespace
} // namespace dss::test
