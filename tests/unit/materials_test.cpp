/// Bodies of several materials (Problem::materials).
#include "solver/model/file_digest.hpp"
#include "solver/model/stress/stress_field.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/scene/solid.hpp"
#include "solver/statics/equilibrium.hpp"
#include "solver/statics/modal.hpp"
#include "tests/fixtures/solids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dss {
namespace {

constexpr double h = 0.01;
constexpr double soft_E = 4e6, stiff_E = 12e6;

Material of_stiffness(double E, double nu = 0) {
  const double G = E / (2 * (1 + nu));
  return {{E, E, E}, {G, G, G}, 0, nu};
}

/// A block whose cells have the material 2 from some place on along an axis, 1 before it.
Problem two_materials(std::array<int, 3> size, std::size_t axis, int from, double nu = 0,
                      double density_ratio = 1) {
  Problem problem = fixture::empty_problem("layers");
  append_body(problem.lattice, fixture::whole_grid(size[0], size[1], size[2]), 0);
  Body body;
  body.name = "layers";
  body.law = LinkLaw::material;
  body.edge = {h, h, h};
  body.mass = fixture::solid_rho * h * h * h;
  body.inertia = box_inertia(body.mass, body.edge);
  if (density_ratio != 1) body.mass_ratios = {1, 1, density_ratio};
  problem.bodies.push_back(body);
  problem.lattice.for_each_element([&](std::size_t, const Row& row, int x) {
    const std::array<int, 3> cell = {x, row.y, row.z};
    problem.materials.push_back(cell[axis] >= from ? 2 : 1);
  });
  const BodyMaterials materials(
      std::map<int, Material>{{1, of_stiffness(soft_E, nu)}, {2, of_stiffness(stiff_E, nu)}});
  set_solid_links({{materials}, {}}, problem);
  return problem;
}

/// Clamps the lower end along x and pulls the upper one by a total force; all motion is along x.
std::vector<double> pulled(Problem problem, double force, bool is_along_x_alone = true) {
  int last = 0;
  problem.lattice.for_each_element(
      [&](std::size_t, const Row&, int x) { last = std::max(last, x); });
  Load load;
  problem.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    if (x == 0)
      problem.clamps.push_back({e, dof_all});
    else if (is_along_x_alone)
      problem.clamps.push_back({e, std::uint8_t(dof_all & ~dof_ux)});
    if (x == last) load.elements.push_back(e);
  });
  load.force[0] = force / double(load.elements.size());
  problem.loads.push_back(load);
  StaticSystem system(problem, Rotation::linearised);
  const Equilibrium found = find_equilibrium(system, {.solver = SolverKind::direct});
  EXPECT_TRUE(found.is_found) << found.reason;
  return system.fields(found.state);
}

TEST(Materials, in_series_have_the_stiffness_of_both_halves_of_their_link) {
  const Problem bar = two_materials({10, 3, 3}, 0, 4);
  const std::vector<double> state = pulled(bar, 9);
  // From the centre of the first element to that of the last one: 3.5 soft and 5.5 stiff lengths.
  const double expected = 9 / (9 * h * h) * h * (3.5 / soft_E + 5.5 / stiff_E);
  EXPECT_NEAR(state[state.size() - field_count + ux] / expected, 1, 1e-9);
}

TEST(Materials, side_by_side_share_a_force_by_their_stiffness) {
  const Problem bar = two_materials({60, 4, 1}, 1, 2);
  const std::vector<double> state = pulled(bar, 4);
  // Far from its ends all rows have the strain of a bar of the mean stiffness.
  bar.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    if (x != 25) return;
    const double strain =
        (state[(e + 10) * field_count + ux] - state[e * field_count + ux]) / (10 * h);
    EXPECT_NEAR(strain * (4 * h * h) * (soft_E + stiff_E) / 2 / 4, 1, 1e-3);
  });
}

TEST(Materials, that_are_alike_have_the_links_of_one) {
  for (const double nu : {0.0, 0.3}) {
    Problem two = two_materials({5, 4, 3}, 1, 2, nu);
    two.bodies[0].more_kinds.clear();
    two.bodies[0].pressures.clear();
    const Material same = of_stiffness(soft_E, nu);
    set_solid_links({{BodyMaterials(std::map<int, Material>{{1, same}, {2, same}})}, {}}, two);
    Problem one = two;
    one.materials.clear();
    one.bodies[0].more_kinds.clear();
    one.bodies[0].pressures.clear();
    set_solid_links({{same}, {}}, one);
    two.lattice.for_each_link([&](std::size_t i, std::size_t, int axis) {
      EXPECT_EQ(two.bodies[0].link(axis, two.link_kind(i, axis)),
                one.bodies[0].link(axis, one.link_kind(i, axis)));
    });
    for (std::size_t e = 0; e < two.lattice.element_count; ++e)
      EXPECT_EQ(two.pressure(e, two.bodies[0]), one.pressure(e, one.bodies[0]));
  }
}

/// Frequency [Hz] of the first longitudinal mode of a clamped bar of two materials, from the centre
/// of the first element to the free end: tan(k1 a) tan(k2 b) = Z1 / Z2.
double first_longitudinal(double a, double b, double density_ratio) {
  const double rho1 = fixture::solid_rho, rho2 = density_ratio * rho1,
               c1 = std::sqrt(soft_E / rho1), c2 = std::sqrt(stiff_E / rho2),
               impedances = rho1 * c1 / (rho2 * c2);
  double low = 0, high = std::numbers::pi / 2 / std::max(a / c1, b / c2) * (1 - 1e-12);
  for (int n = 0; n < 200; ++n) {
    const double w = (low + high) / 2;
    (std::tan(w * a / c1) * std::tan(w * b / c2) < impedances ? low : high) = w;
  }
  return low / (2 * std::numbers::pi);
}

TEST(Materials, of_different_densities_vibrate_as_their_wave_equation_says) {
  double error = 1;
  for (const int n : {10, 20, 40}) {
    Problem bar = two_materials({n, 1, 1}, 0, n / 2, 0, 0.25);
    bar.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
      bar.clamps.push_back({e, x == 0 ? std::uint8_t(dof_all) : std::uint8_t(dof_all & ~dof_ux)});
    });
    const StaticSystem system(bar, Rotation::linearised, dof_all);
    const double frequency =
        find_modes(system, 1, system.rest(), true).modes[0].omega / (2 * std::numbers::pi);
    const double expected = first_longitudinal((n / 2 - 0.5) * h, (n - n / 2) * h, 0.25);
    const double next = std::abs(frequency / expected - 1);
    EXPECT_LT(next, 0.4 * error) << n;
    error = next;
  }
  EXPECT_LT(error, 1e-3);
}

TEST(Materials, contract_as_each_of_them_does_to_first_order) {
  // A bar in series, pulled: strains across far from the seam are -nu stress / E of each.
  Problem bar = two_materials({24, 4, 4}, 0, 12, 0.3);
  const std::vector<double> state = pulled(bar, 16, false);
  const double stress = 16 / (16 * h * h);
  const auto across = [&](int at) {
    double low = 0, high = 0;
    bar.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
      if (x == at && row.y == 0) low += state[e * field_count + uy] / 4;
      if (x == at && row.y == 3) high += state[e * field_count + uy] / 4;
    });
    return (high - low) / (3 * h);
  };
  EXPECT_NEAR(across(6) / (-0.3 * stress / soft_E), 1, 0.01);
  EXPECT_NEAR(across(18) / (-0.3 * stress / stiff_E), 1, 0.01);
}

TEST(Materials, have_a_stress_that_jumps_at_their_seam) {
  Problem bar = two_materials({40, 4, 4}, 1, 2);
  const std::vector<double> state = pulled(bar, 16);
  const StressField field(bar, state, Rotation::linearised, signals_at(bar, 0));
  const double strain = 16 / (16 * h * h) / ((soft_E + stiff_E) / 2);
  bar.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (x != 20) return;
    const double own = strain * (row.y < 2 ? soft_E : stiff_E);
    EXPECT_NEAR(field.elements()[e].stress[0] / own, 1, 1e-2) << row.y;
    for (const std::size_t face : {2U, 3U}) // towards the seam and away from it
      EXPECT_NEAR(field.at_face(e, face)[0] / own, 1, 1e-2) << row.y << " " << face;
  });
}

TEST(Materials, sizes_and_selections_are_part_of_the_digest_of_files) {
  const Problem bar = two_materials({6, 2, 2}, 0, 3);
  const auto differs = [&](auto&& change) {
    Problem other = bar;
    change(other);
    return file_digest(other) != file_digest(bar);
  };
  EXPECT_FALSE(differs([](Problem&) {}));
  EXPECT_TRUE(differs([](Problem& other) { other.bodies[0].edge[1] *= 2; }));
  EXPECT_TRUE(differs([](Problem& other) { other.bodies[0].origin[2] = 1; }));
  EXPECT_TRUE(differs([](Problem& other) { other.materials[0] = 2; }));
  EXPECT_TRUE(differs([](Problem& other) { other.clamps.push_back({1, dof_all}); }));
  EXPECT_TRUE(differs([](Problem& other) { other.loads.push_back({{2}, {}, {}, {}}); }));
}

TEST(Materials, fall_alike_whatever_their_density) {
  const Problem bar = two_materials({6, 2, 2}, 0, 3, 0, 5);
  EXPECT_TRUE(bar.has_mass_ratios());
  EXPECT_EQ(bar.mass_ratio(0, bar.bodies[0]), 1);
  EXPECT_EQ(bar.mass_ratio(bar.lattice.element_count - 1, bar.bodies[0]), 5);
}

} // namespace
} // namespace dss
