#include "solver/scene/constants.hpp"

#include "solver/scene/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dss {
namespace {

TEST(torsion_constant, of_rectangles_agrees_with_the_published_table) {
  // Timoshenko and Goodier, section 109: J / (b c^3) for b/c = 1, 2, 10 (four digits), and 1/3 for
  // a thin strip.
  EXPECT_NEAR(torsion_constant(1, 1), 0.1406, 5e-5);
  EXPECT_NEAR(torsion_constant(2, 1) / 2, 0.229, 5e-4);
  EXPECT_NEAR(torsion_constant(10, 1) / 10, 0.312, 5e-4);
  EXPECT_NEAR(torsion_constant(1e6, 1) / 1e6, 1.0 / 3, 1e-6);
  EXPECT_EQ(torsion_constant(3, 2), torsion_constant(2, 3));
}

TEST(torsion_constant, equals_the_plain_series) {
  for (const double ratio : {1.0, 1.3, 2.0, 5.0}) {
    double sum = 0;
    for (int n = 1; n < 2001; n += 2)
      sum += std::tanh(n * std::numbers::pi * ratio / 2) / std::pow(n, 5);
    const double series = ratio * (1.0 / 3 - 64 / std::pow(std::numbers::pi, 5) / ratio * sum);
    EXPECT_NEAR(torsion_constant(ratio, 1) / series, 1, 1e-12);
  }
}

TEST(material_link, has_the_stiffness_of_a_bar_of_its_section) {
  const Material material = {{200, 200, 200}, {80, 80, 80}, 0.1};
  const Vec3 edge = {0.5, 0.2, 0.3}, inertia = {2, 3, 4};
  const double mass = 5, length = 0.2, area = 0.5 * 0.3; // a link along y has faces z x x
  const AxisConstants link = material_link(material, 1, edge, mass, inertia);
  EXPECT_DOUBLE_EQ(link.k_normal, 200 * area / length);
  EXPECT_DOUBLE_EQ(link.k_shear[0], 80 * area / length);
  EXPECT_DOUBLE_EQ(link.k_shear[2], 80 * area / length);
  EXPECT_DOUBLE_EQ(link.k_rot[0], 200 * 0.5 * 0.3 * 0.3 * 0.3 / 12 / length); // about x, z^2 counts
  EXPECT_DOUBLE_EQ(link.k_rot[1], 80 * torsion_constant(0.5, 0.3) / length);
  EXPECT_DOUBLE_EQ(link.k_rot[2], 200 * 0.3 * 0.5 * 0.5 * 0.5 / 12 / length);
  EXPECT_DOUBLE_EQ(link.d_normal, 0.2 * std::sqrt(link.k_normal * mass));
  EXPECT_DOUBLE_EQ(link.d_rot[2], 0.2 * std::sqrt(link.k_rot[2] * 4));
}

TEST(scene_constants, of_a_material_body_are_those_of_its_box) {
  const Scene scene = load_scene("tumbling_box");
  const Body& body = scene.problem.bodies.at(0);
  const double mass = 1000 * 0.1 * 0.08 * 0.05;
  EXPECT_EQ(body.law, LinkLaw::material);
  EXPECT_DOUBLE_EQ(body.mass, mass);
  EXPECT_DOUBLE_EQ(body.inertia[0], mass / 12 * (0.08 * 0.08 + 0.05 * 0.05));
  EXPECT_TRUE(body.has_tensor_inertia());
  EXPECT_DOUBLE_EQ(body.axis[0].k_normal, 1e6 * 0.08 * 0.05 / 0.1);
  EXPECT_DOUBLE_EQ(body.axis[0].k_shear[1], 1e6 / 2.4 * 0.08 * 0.05 / 0.1);
  EXPECT_DOUBLE_EQ(body.axis[2].d_normal, 0.04 * std::sqrt(body.axis[2].k_normal * mass / 2));
}

TEST(scene_constants, of_a_paper_body_are_isotropic_and_default_to_the_published_ones) {
  const Scene scene = load_scene("two_elements", {{"bodies/0/constants/mass", "2"}});
  const Body& body = scene.problem.bodies.at(0);
  EXPECT_EQ(body.law, LinkLaw::paper);
  EXPECT_EQ(body.mass, 2);
  for (int axis = 0; axis < 3; ++axis) {
    const AxisConstants& link = body.axis[std::size_t(axis)];
    EXPECT_EQ(link.k_normal, 1e4);
    EXPECT_EQ(link.k_shear, across(axis, link.k_normal));
    EXPECT_EQ(link.d_shear, across(axis, link.d_normal));
    EXPECT_EQ(link.d_rot, (Vec3{0.1, 0.1, 0.1}));
  }
  const Body plate = load_scene("plate_paper", {{"n", "4"}}).problem.bodies.at(0);
  EXPECT_EQ(plate.axis[0].k_normal, 1e11);
  EXPECT_EQ(plate.axis[1].d_normal, 1e5);
  EXPECT_EQ(plate.axis[0].k_rot, (Vec3{0, 0, 0}));
  EXPECT_EQ(plate.axis[0].d_rot, (Vec3{100, 100, 100}));
  EXPECT_EQ(plate.inertia, (Vec3{1, 1, 1}));
}

} // namespace
} // namespace dss
