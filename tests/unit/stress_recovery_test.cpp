/// Stress and strain of solids against closed forms, in the middle of elements, on faces, at nodes.
#include "solver/model/rotation_vector.hpp"
#include "tests/fixtures/stresses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace dss::test {
namespace {

using Vec = Eigen::Vector3d;
using Mat = Eigen::Matrix3d;
using fixture::stress_at_rest;
using fixture::symmetric;
using StressAt = std::function<Mat(const Vec&)>;

constexpr double h = 0.01;

/// Largest errors of a field, over the largest component of the exact stress.
struct Errors {
  double middle = 0, face = 0, node = 0;
  double largest() const { return std::max({middle, face, node}); }
};
/// @param counts  whether a place counts
Errors errors(
    const Problem& problem, const StressField& field, const StressAt& exact,
    const std::function<bool(const Vec&)>& counts = [](const Vec&) { return true; }) {
  Errors error;
  double largest = 0;
  const ElementNodes nodes(problem.lattice);
  const std::vector<SymmetricTensor> at_nodes = field.at_nodes(nodes);
  const auto off = [&](const SymmetricTensor& found, const Vec& place) {
    const Mat stress = exact(place);
    largest = std::max(largest, stress.cwiseAbs().maxCoeff());
    EXPECT_TRUE(matrix_of(found).allFinite());
    return counts(place) ? (matrix_of(found) - stress).cwiseAbs().maxCoeff() : 0;
  };
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec place = fixture::rest_place(problem, row, x);
    const Vec3& edge = problem.bodies[0].edge;
    const Vec half = Vec(edge[0], edge[1], edge[2]) / 2;
    error.middle = std::max(error.middle, off(field.elements()[e].stress, place));
    for (std::size_t f = 0; f < 6; ++f) {
      const auto a = Eigen::Index(f / 2);
      const Vec at = place + (f % 2 == 1 ? 1 : -1) * half[a] * Vec::Unit(a);
      error.face = std::max(error.face, off(field.at_face(e, f), at));
    }
    for (std::size_t corner = 0; corner < 8; ++corner) {
      Vec at = place;
      for (int a = 0; a < 3; ++a) at[a] += (corner >> a & 1) != 0 ? half[a] : -half[a];
      error.node = std::max(error.node, off(at_nodes[nodes.of(e)[corner]], at));
    }
  });
  return {error.middle / largest, error.face / largest, error.node / largest};
}

/// A block without its upper quarter.
VoxelGrid corner_block() {
  VoxelGrid grid = fixture::whole_grid(5, 4, 4);
  for (int z = 0; z < 4; ++z)
    for (int y = 2; y < 4; ++y)
      for (int x = 2; x < 5; ++x) grid.occupied[std::size_t(x + 5 * (y + 4 * z))] = 0;
  return grid;
}

TEST(StressRecovery, of_uniform_stress_is_exact) {
  const std::pair<VoxelGrid, Vec3> bodies[] = {
      {fixture::whole_grid(4, 3, 5), {h, 0.7 * h, 1.6 * h}}, {corner_block(), {h, h, h}}};
  for (const double nu : {0.0, 0.3, 0.45})
    for (const auto& [grid, edge] : bodies)
      for (const Mat& stress :
           {symmetric(1, 0, 0, 0, 0, 0), symmetric(0, 0, 0, 0, 0, 1),
            symmetric(-1, -1, -1, 0, 0, 0), symmetric(1, -.4, .3, .5, -.7, .2)}) {
        Problem problem = fixture::contracting_solid(grid, edge, nu);
        fixture::load_faces(problem, nu, [&](const Vec&, const Vec& n) { return Vec(stress * n); });
        problem.clamps = {{0, dof_all}};
        const StressField field = stress_at_rest(problem);
        const Errors error = errors(problem, field, [&](const Vec&) { return stress; });
        EXPECT_LE(error.largest(), 1e-10) << nu;
        const double G = fixture::solid_mu;
        const Mat strain = (stress - nu / (1 + nu) * stress.trace() * Mat::Identity()) / (2 * G);
        for (const ElementStress& element : field.elements())
          EXPECT_LE((matrix_of(element.strain) - strain).norm(), 1e-10 * strain.norm()) << nu;
      }
}

Problem beam(int nx, int ny, int nz, const Vec3& edge, double nu) {
  return fixture::contracting_solid(fixture::whole_grid(nx, ny, nz), edge, nu);
}
/// Clamps the faces -x.
void clamp_end(Problem& problem, std::uint8_t dofs = dof_all) {
  problem.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    if (x == 0) problem.clamps.push_back({e, dofs, {dofs}});
  });
}

TEST(StressRecovery, of_a_hanging_column_is_exact_at_the_clamp) {
  for (const int layers : {1, 3}) {
    Problem column = beam(6, layers, layers, {h, h, h}, 0);
    clamp_end(column);
    column.frame_acceleration[0].amplitude = 9.81;
    const double weight = 9.81 * fixture::solid_rho, length = 6 * h;
    const Errors error = errors(column, stress_at_rest(column), [&](const Vec& at) {
      return symmetric(weight * (length - at.x()), 0, 0, 0, 0, 0);
    });
    EXPECT_LE(error.largest(), 1e-10) << layers;
  }
}

TEST(StressRecovery, of_a_bent_beam_is_exact_at_its_surface_and_at_the_clamp) {
  for (const int layers : {1, 2, 4}) {
    Problem bent = beam(6, 2, layers, {h, h, h}, 0);
    clamp_end(bent);
    const double middle = layers * h / 2;
    const StressAt exact = [&](const Vec& at) { return symmetric(at.z() - middle, 0, 0, 0, 0, 0); };
    fixture::load_faces(bent, 0, [&](const Vec& at, const Vec& n) { return Vec(exact(at) * n); });
    const Errors error = errors(bent, stress_at_rest(bent), exact);
    EXPECT_LE(std::max(error.face, error.node), 1e-10) << layers;
  }
}

/// A plate of one layer in the state w(x, y), with the rotations of its normals.
Problem thin_plate(double nu) { return beam(5, 5, 1, {h, h, h / 2}, nu); }
std::vector<double> bent_state(const Problem& plate, const std::function<Vec(const Vec&)>& bend) {
  std::vector<double> state(plate.lattice.element_count * field_count);
  plate.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec w = bend(fixture::rest_place(plate, row, x)); // w and its slopes
    double* fields = &state[e * field_count];
    fields[uz] = w[0], fields[qx] = w[2] / 2, fields[qy] = -w[1] / 2;
    to_quaternion(std::span(fields, field_count));
  });
  return state;
}

TEST(StressRecovery, of_bent_and_twisted_plates_is_that_of_their_surface) {
  constexpr double nu = 0.3, curvature = 1e-4, G = fixture::solid_mu, E = 2 * G * (1 + nu);
  const Problem plate = thin_plate(nu);
  const std::size_t inner = 12;
  const auto surface = [&](const std::function<Vec(const Vec&)>& bend, std::size_t face) {
    const std::vector<double> state = bent_state(plate, bend);
    return matrix_of(StressField(plate, state, Rotation::linearised, {}).at_face(inner, face));
  };
  const double z = h / 4; // half the thickness
  const auto cylinder = [&](const Vec& at) {
    return Vec(curvature * at.x() * at.x() / 2, curvature * at.x(), 0);
  };
  const double pull = -E / (1 - nu * nu) * curvature * z;
  EXPECT_LE((surface(cylinder, 5) - symmetric(pull, nu * pull, 0, 0, 0, 0)).norm(),
            1e-6 * std::abs(pull));
  EXPECT_LE((surface(cylinder, 4) + symmetric(pull, nu * pull, 0, 0, 0, 0)).norm(),
            1e-6 * std::abs(pull));
  const auto twisted = [&](const Vec& at) {
    return Vec(curvature * at.x() * at.y(), curvature * at.y(), curvature * at.x());
  };
  const double shear = -2 * G * curvature * z;
  EXPECT_LE((surface(twisted, 5) - symmetric(0, 0, 0, shear, 0, 0)).norm(), 1e-6 * std::abs(shear));
}

/// A chain that a force bends: its links leave the shear of elements to their moments.
TEST(StressRecovery, of_a_chain_has_its_shear_and_the_bending_of_its_surface) {
  Problem chain = beam(5, 1, 1, {2 * h, h, h}, 0.3);
  clamp_end(chain);
  constexpr double force = 1e-3; // [N]
  chain.loads = {{{4}, {0, 0, force}, {}, {}, 0, 1}};
  const StressField field = stress_at_rest(chain);
  const double area = h * h, modulus = h * h * h / 6;
  for (std::size_t e = 1; e < 4; ++e) { // the force acts in the middle of the last element
    const SymmetricTensor middle = field.of(e).stress, top = field.at_face(e, 5);
    EXPECT_NEAR(middle[4], force / area, 1e-9 * force / area);
    EXPECT_NEAR(middle[0], 0, 1e-9 * force / area);
    const double bent = -force * 2 * h * double(4 - e) / modulus;
    EXPECT_NEAR(top[0], bent, 1e-9 * std::abs(bent));
    EXPECT_NEAR(field.at_face(e, 4)[0], -bent, 1e-9 * std::abs(bent));
    EXPECT_NEAR(top[4], 0, 1e-9 * force / area);
    EXPECT_NEAR(field.at(e, {0, 0, 0.5})[0], bent / 2, 1e-9 * std::abs(bent));
  }
}

/// A plate 2 x 1 under the plane stress of Airy's function x^2 y^2 - y^4 / 3.
struct AiryPlate {
  double nu;
  static Mat exact(const Vec& at) {
    const double x = at.x(), y = at.y();
    return symmetric(2 * x * x - 4 * y * y, 2 * y * y, 0, -4 * x * y, 0, 0);
  }
  Errors errors_of(int layers, const std::function<bool(const Vec&)>& counts) const {
    const double edge = 1.0 / layers;
    Problem plate = beam(2 * layers, layers, 1, {edge, edge, edge}, nu);
    fixture::load_faces(plate, nu, [&](const Vec& at, const Vec& n) { return Vec(exact(at) * n); });
    plate.clamps = {{0, dof_all}}; // the tractions balance
    return errors(plate, stress_at_rest(plate), exact, counts);
  }
};

// Near edges of the plate, where two loaded faces meet, the order is 1.
TEST(StressRecovery, of_a_loaded_plate_converges) {
  const auto is_far_from_edges = [](const Vec& at) {
    return (at.x() > 0.4 && at.x() < 1.5) || (at.y() > 0.3 && at.y() < 0.7);
  };
  const auto is_anywhere = [](const Vec&) { return true; };
  for (const double nu : {0.0, 0.3}) {
    const AiryPlate plate{nu};
    const Errors coarse = plate.errors_of(16, is_far_from_edges),
                 fine = plate.errors_of(32, is_far_from_edges),
                 all_coarse = plate.errors_of(16, is_anywhere),
                 all_fine = plate.errors_of(32, is_anywhere);
    for (const auto of : {&Errors::middle, &Errors::face, &Errors::node}) {
      EXPECT_GT(std::log2(coarse.*of / (fine.*of)), nu == 0 ? 1.7 : 1.4) << nu;
      EXPECT_GT(std::log2(all_coarse.*of / (all_fine.*of)), 0.8) << nu;
    }
  }
}

TEST(Tensor, has_principal_values_and_an_equivalent_stress) {
  const SymmetricTensor shear = {0, 0, 0, 0, 0, 2}, pull = {3, 0, 0, 0, 0, 0},
                        pressure = {-1, -1, -1, 0, 0, 0};
  EXPECT_NEAR(von_mises(shear), 2 * std::sqrt(3), 1e-15);
  EXPECT_EQ(von_mises(pull), 3);
  EXPECT_EQ(von_mises(pressure), 0);
  const Vec3 of_shear = principal_values(shear);
  EXPECT_NEAR(of_shear[0], 2, 1e-14);
  EXPECT_NEAR(of_shear[1], 0, 1e-14);
  EXPECT_NEAR(of_shear[2], -2, 1e-14);
  EXPECT_EQ(symmetric_part(matrix_of({1, 2, 3, 4, 5, 6})), (SymmetricTensor{1, 2, 3, 4, 5, 6}));
}

} // namespace
} // namespace dss::test
