/// A body that is turned by right angles or mirrored, with all that acts on it, moves as the body
/// itself does, turned or mirrored: links have no preferred axis and no preferred direction. One
/// exception: where two shears differ, at thin places, the law sets one of the two axes across
/// apart (ShearAxes), which shows to second order in the relative rotation of two elements.
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/dynamics.hpp"
#include "tests/fixtures/solids.hpp"
#include "tests/fixtures/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace dss {
namespace {

using Eigen::Matrix3d;

constexpr double h = 0.01, nu = 0.3;
using fixture::all_symmetries, fixture::Cell, fixture::numbers_of, fixture::Symmetry;

constexpr Cell base_size = {5, 3, 4};

/// Two materials. @param has_holes  and thin places
std::map<Cell, int> base_cells(bool has_holes) {
  std::map<Cell, int> cells;
  std::mt19937 generator(7);
  for (int z = 0; z < base_size[2]; ++z)
    for (int y = 0; y < base_size[1]; ++y)
      for (int x = 0; x < base_size[0]; ++x)
        if (!has_holes || generator() % 4 != 0) cells[{x, y, z}] = 1 + int(generator() % 2);
  return cells;
}

Problem body_of(const std::map<Cell, int>& cells, const Cell& size) {
  VoxelGrid grid{size[0], size[1], size[2], {}};
  grid.occupied.assign(std::size_t(size[0] * size[1] * size[2]), 0);
  for (const auto& [cell, material] : cells)
    grid.occupied[std::size_t((cell[2] * size[1] + cell[1]) * size[0] + cell[0])] =
        std::uint8_t(material);
  Problem problem = fixture::empty_problem("symmetric");
  append_body(problem.lattice, grid, 0);
  for (const std::uint8_t cell : grid.occupied)
    if (cell != 0) problem.materials.push_back(cell);
  Body body;
  body.name = "body", body.law = LinkLaw::material, body.edge = {h, h, h};
  body.mass = fixture::solid_rho * h * h * h;
  body.inertia = box_inertia(body.mass, body.edge);
  body.mass_ratios = {1, 1, 2.5};
  problem.bodies.push_back(body);
  Material other = fixture::contracting(0.1);
  other.damping_ratio = 0.02;
  const BodyMaterials materials(std::map<int, Material>{{1, fixture::contracting(nu)}, {2, other}});
  set_solid_links({{materials}, {}}, problem);
  return problem;
}

/// What acts on the body as it is, by cells.
struct Action {
  Cell cell;
  Vec3 force, torque;
};
std::vector<Action> base_actions(const std::map<Cell, int>& cells) {
  std::vector<Action> actions;
  int n = 0;
  for (const auto& [cell, material] : cells) {
    if (++n % 5 != 0) continue;
    actions.push_back({cell, {0.1 * n, -0.2, 0.3}, {1e-4, 2e-4 * n, -1e-4}});
  }
  return actions;
}

Problem transformed(const std::map<Cell, int>& cells, const Symmetry& by) {
  const Matrix3d m = by.matrix();
  std::map<Cell, int> own;
  for (const auto& [cell, material] : cells) own[by.of(cell, base_size)] = material;
  const Cell size = {base_size[by.axis[0]], base_size[by.axis[1]], base_size[by.axis[2]]};
  Problem problem = body_of(own, size);
  const auto numbers = numbers_of(problem);
  for (const Action& action : base_actions(cells)) {
    Load load;
    load.elements = {numbers.at(by.of(action.cell, base_size))};
    load.force = fixture::product(m, action.force);
    load.torque = fixture::product(by.axial_matrix(), action.torque);
    problem.loads.push_back(load);
  }
  const Vec3 gravity = fixture::product(m, {1, -2, 9.81});
  for (std::size_t a = 0; a < 3; ++a) problem.frame_acceleration[a].amplitude = gravity[a];
  problem.stabilization = {20, 0.5, 1e-3, 1e-5};
  return problem;
}

/// A state or its rates, turned or mirrored.
std::vector<double> transformed(const std::vector<double>& fields, const Problem& from,
                                const Problem& to, const Symmetry& by) {
  const auto numbers = numbers_of(to);
  std::vector<double> out(fields.size());
  from.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const std::size_t number = numbers.at(by.of({x, row.y, row.z}, base_size));
    fixture::transform(by, &fields[e * field_count], &out[number * field_count]);
  });
  return out;
}

std::vector<double> rates_of(const Problem& problem, Rotation rotation,
                             const std::vector<double>& state) {
  reference::Dynamics<double> dynamics(problem, rotation);
  std::vector<double> rates(state.size());
  dynamics.rates(state, signals_at(problem, 0.01), rates);
  return rates;
}

/// Largest difference over all symmetries, over the largest rate.
double asymmetry(bool has_holes, Rotation rotation, double angle) {
  const std::map<Cell, int> cells = base_cells(has_holes);
  const Problem base = transformed(cells, {});
  const std::vector<double> state = fixture::random_state(base, 3, 1e-3 * angle, angle, 0.1),
                            rates = rates_of(base, rotation, state);
  const std::vector<Symmetry> all = all_symmetries();
  EXPECT_EQ(all.size(), 48U);
  double largest = 0, difference = 0;
  for (const Symmetry& by : all) {
    const Problem other = transformed(cells, by);
    const std::vector<double> expected = transformed(rates, base, other, by),
                              found =
                                  rates_of(other, rotation, transformed(state, base, other, by));
    for (std::size_t n = 0; n < found.size(); ++n) {
      largest = std::max(largest, std::abs(expected[n]));
      const double here = std::abs(found[n] - expected[n]);
      if (!(here <= difference)) difference = here; // also if NaN
    }
  }
  return difference / largest;
}

TEST(Symmetry, turned_and_mirrored_bodies_move_alike) {
  EXPECT_LT(asymmetry(true, Rotation::linearised, 1), 1e-12);
  EXPECT_LT(asymmetry(false, Rotation::quaternion, 1), 1e-12);
}

TEST(Symmetry, of_thin_places_holds_to_second_order_in_rotations) {
  const double at_once = asymmetry(true, Rotation::quaternion, 0.02),
               at_half = asymmetry(true, Rotation::quaternion, 0.01);
  EXPECT_LT(at_once, 1e-3);
  EXPECT_GT(at_once / at_half, 1.8); // of forces that are of first order themselves
}

TEST(Symmetry, bodies_move_alike_wherever_they_are) {
  Problem base = transformed(base_cells(true), {});
  const std::vector<double> state = fixture::random_state(base, 3, 1e-3, 1.0, 0.1),
                            rates = rates_of(base, Rotation::quaternion, state);
  base.bodies[0].origin = {3, -5, 1e4};
  // To the last bit: links know no places.
  EXPECT_EQ(rates_of(base, Rotation::quaternion, state), rates);
}

} // namespace
} // namespace dss
