#include "solver/decomposition/part.hpp"
#include "solver/scene/solid.hpp"
#include "solver/statics/equilibrium.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

constexpr double E = 7e6, G = 2.6e6, h = 0.01;

Material isotropic() { return {{E, E, E}, {G, G, G}, 0.02}; }

Body solid_body(const Vec3& edge = {h, h, h}) {
  Body body;
  body.name = "solid";
  body.law = LinkLaw::material;
  body.edge = edge;
  body.mass = 1e-3;
  body.inertia = box_inertia(body.mass, edge);
  return body;
}

/// A solid of nx * ny * nz elements.
Problem solid_block(int nx, int ny, int nz, const Vec3& edge = {h, h, h}, double nu = 0) {
  Problem problem = fixture::empty_problem("solid");
  fixture::add_block(problem, solid_body(edge), nx, ny, nz);
  Material material = isotropic();
  if (nu > 0) material.G.fill(E / (2 * (1 + nu))), material.nu = nu;
  set_solid_links({{material}, {}}, problem);
  return problem;
}

/// A flat strip that ends in a block.
Problem stepped_bar() {
  Problem problem = fixture::empty_problem("stepped");
  VoxelGrid grid{9, 3, 3, {}};
  for (int cell = 0; cell < 81; ++cell) grid.occupied.push_back(cell % 9 > 4 || cell / 27 == 1);
  append_body(problem.lattice, grid, 0);
  problem.bodies.push_back(solid_body());
  set_solid_links({{isotropic()}, {}}, problem);
  return problem;
}

/// Mean rotation of the section at x about an axis [rad].
double section_turn(const Problem& problem, const std::vector<double>& state, int at, Field axis) {
  double sum = 0;
  int count = 0;
  problem.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    if (x == at) sum += 2 * state[e * field_count + axis], ++count;
  });
  return sum / count;
}

/// Rotation a metre and N m in the middle of a bar of `layers` by `layers` elements that a small
/// moment twists (axis qx) or bends (qy).
double turn_rate(int layers, Field axis, double nu = 0) {
  const int length = std::max(12, 6 * layers), from = length / 3, to = 2 * length / 3;
  Problem bar = solid_block(length, layers, layers, {h, h, h}, nu);
  Load load;
  bar.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    if (x == 0) bar.clamps.push_back({e, dof_all});
    if (x == length - 1) load.elements.push_back(e);
  });
  constexpr double moment = 1e-8; // [N m]
  load.torque[std::size_t(axis - qx)] = moment / (layers * layers);
  bar.loads = {load};
  StaticSystem system(bar, Rotation::linearised);
  const Equilibrium found = find_equilibrium(system, {.solver = SolverKind::direct});
  EXPECT_TRUE(found.is_found) << found.reason;
  const std::vector<double> state = system.fields(found.state);
  return (section_turn(bar, state, to, axis) - section_turn(bar, state, from, axis)) /
         ((to - from) * h * moment);
}

// A body of beams (law `material`) comes to half of it as layers are added.
TEST(Solid, bar_of_any_number_of_layers_has_the_torsional_stiffness_of_its_section) {
  for (const int layers : {1, 2, 3, 4, 6})
    EXPECT_NEAR(1 / (turn_rate(layers, qx) * G * torsion_constant(layers * h, layers * h)), 1, 0.01)
        << layers << " layers";
}

TEST(Solid, bar_of_any_number_of_layers_bends_as_its_section) {
  for (const int layers : {1, 2, 3, 4})
    EXPECT_NEAR(12 / (turn_rate(layers, qy) * E * std::pow(layers * h, 4)), 1, 0.003)
        << layers << " layers";
}

// What the trial came to (shared/solid.md): bending 1, 0.980, 0.996, 0.999 for nu = 0.3.
TEST(Solid, bar_of_any_number_of_layers_bends_and_twists_with_its_lateral_contraction) {
  for (const double nu : {0.3, 0.45})
    for (const int layers : {1, 2, 3, 4}) {
      EXPECT_NEAR(12 / (turn_rate(layers, qy, nu) * E * std::pow(layers * h, 4)), 1, 0.022)
          << nu << ": " << layers << " layers";
      const double twist = E / (2 * (1 + nu)) * torsion_constant(layers * h, layers * h);
      EXPECT_NEAR(1 / (turn_rate(layers, qx, nu) * twist), 1, 0.011)
          << nu << ": " << layers << " layers";
    }
}

// A strip that is held from contracting across bends as a plate does.
TEST(Solid, plate_of_one_layer_is_stiffened_by_its_contraction) {
  constexpr double nu = 0.3;
  const int length = 12;
  Problem strip = solid_block(length, 3, 1, {h, h, h}, nu);
  Load load;
  strip.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    strip.clamps.push_back({e, x == 0 ? std::uint8_t(dof_all) : std::uint8_t(dof_rx | dof_uy)});
    if (x == length - 1) load.elements.push_back(e);
  });
  constexpr double moment = 1e-8; // [N m]
  load.torque[1] = moment / 3;
  strip.loads = {load};
  StaticSystem system(strip, Rotation::linearised);
  const Equilibrium found = find_equilibrium(system, {.solver = SolverKind::direct});
  ASSERT_TRUE(found.is_found) << found.reason;
  const std::vector<double> state = system.fields(found.state);
  const auto middle = [&](int at) { // the row in the middle has no free edge
    double turn = 0;
    strip.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
      if (x == at && row.y == 1) turn = 2 * state[e * field_count + qy];
    });
    return turn;
  };
  const double rate = (middle(8) - middle(4)) / (4 * h * moment);
  // Between the strip that contracts freely and the plate: its outer rows have one free face each.
  const double bar = 12 / (rate * E * 3 * std::pow(h, 4));
  EXPECT_GT(bar, 1.02);
  EXPECT_LT(bar, 1 / (1 - nu * nu));
}

TEST(Solid, shear_follows_the_layers_across_the_gap) {
  const Vec3 edge = {0.1, 0.2, 0.05};
  const double area = 0.2 * 0.05, whole = 2 * G * area / 0.1;
  const ThinAxes thin_z = 4;
  const auto shear = [&](ThinAxes i, ThinAxes j) {
    return solid_link(isotropic(), 0, edge, i, j, 1, {1, 1, 1}).k_shear;
  };
  EXPECT_DOUBLE_EQ(shear(0, 0)[1], whole);
  EXPECT_DOUBLE_EQ(shear(0, 0)[2], whole);
  EXPECT_DOUBLE_EQ(shear(thin_z, thin_z)[1], whole);
  EXPECT_DOUBLE_EQ(shear(thin_z, thin_z)[2], 5.0 / 6 * G * area / 0.1);
  EXPECT_DOUBLE_EQ(shear(thin_z, 0)[2], 4 * G * area / 0.1 / 3.4);
  EXPECT_EQ(shear(0, 0)[0], 0);
}

TEST(Solid, twist_follows_the_layers_across_the_link) {
  const Vec3 edge = {0.1, 0.2, 0.05};
  const auto twist = [&](ThinAxes i, ThinAxes j) {
    return solid_link(isotropic(), 0, edge, i, j, 1, {1, 1, 1}).k_rot[0] * 0.1 / G;
  };
  const double flat = 0.2 * std::pow(0.05, 3) / 6, tall = 0.05 * std::pow(0.2, 3) / 6;
  EXPECT_DOUBLE_EQ(twist(0, 0), flat);
  EXPECT_DOUBLE_EQ(twist(4, 4), flat);
  EXPECT_DOUBLE_EQ(twist(2, 2), tall);
  EXPECT_DOUBLE_EQ(twist(6, 6), torsion_constant(0.2, 0.05));
  EXPECT_DOUBLE_EQ(twist(2, 0), (flat + tall) / 2);
}

TEST(Solid, links_of_a_body_of_one_thickness_are_alike) {
  for (const auto& [nx, ny, nz] : {std::array{5, 1, 1}, {5, 4, 1}, {4, 3, 2}, {1, 3, 2}}) {
    const Problem block = solid_block(nx, ny, nz);
    EXPECT_EQ(block.bodies[0].kinds(), 1) << nx << ' ' << ny << ' ' << nz;
    EXPECT_TRUE(block.link_kinds.empty());
  }
}

TEST(Solid, links_where_the_thickness_changes_are_of_other_kinds) {
  const Problem bar = stepped_bar();
  const Body& body = bar.bodies[0];
  EXPECT_EQ(body.kinds(), 3); // along x: both thin, one thin, none
  const auto shear_z = [&](std::size_t element) {
    return body.link(0, bar.link_kind(element, 0)).k_shear[2];
  };
  // The middle layer begins behind three short rows of the lowest one.
  const double whole = 2 * G * h;
  EXPECT_DOUBLE_EQ(shear_z(0), whole);
  EXPECT_DOUBLE_EQ(shear_z(12), whole / 2.4);
  EXPECT_DOUBLE_EQ(shear_z(16), whole * 2 / 3.4);
  EXPECT_DOUBLE_EQ(shear_z(17), whole);
}

TEST(Solid, links_of_parts_are_those_of_the_whole) {
  const Problem bar = stepped_bar();
  const Decomposition cut = decompose(bar, "blocks", 3);
  for (int p = 0; p < 3; ++p) {
    const Part part = make_part(bar, cut, p, 1);
    ASSERT_EQ(part.problem.link_kinds.size(), part.problem.lattice.element_count);
    for (const dss::Run& run : part.runs)
      for (std::size_t k = 0; k < run.count; ++k)
        EXPECT_EQ(part.problem.link_kinds[run.local + k], bar.link_kinds[run.global + k]);
  }
}

TEST(Solid, extra_link_makes_elements_thick_along_its_axis) {
  Problem pair = fixture::empty_problem("pair");
  for (int n = 0; n < 2; ++n) fixture::add_block(pair, solid_body(), 4, 1, 1);
  for (std::size_t x = 0; x < 4; ++x) {
    pair.extra_links.push_back({x, 4 + x, 1, LinkLaw::material, {}});
  }
  Solids solids{{isotropic(), isotropic()}, {}};
  for (std::size_t n = 0; n < 4; ++n) solids.extra_links[n] = isotropic();
  set_solid_links(solids, pair);
  const Problem whole = solid_block(4, 2, 1);
  for (const Body& body : pair.bodies)
    EXPECT_EQ(body.axis[0].k_shear, whole.bodies[0].axis[0].k_shear);
  const AxisConstants &joint = pair.extra_links[1].constants, &link = whole.bodies[0].axis[1];
  EXPECT_EQ(joint.k_shear, link.k_shear);
  EXPECT_EQ(joint.k_normal, link.k_normal);
  EXPECT_EQ(joint.k_rot, link.k_rot);
  EXPECT_EQ(joint.d_shear, link.d_shear);
}

} // namespace
} // namespace dss
