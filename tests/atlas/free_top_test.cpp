#include "experiments/studies/failures/free_top.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace dss {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Attitude start = {Quaterniond(Eigen::AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized())),
                        Vector3d(3, -2, 5)};

/// Integrates Euler's equations in the body and the quaternion by small steps of RK4.
Attitude integrated(const Vector3d& inertia, double t) {
  using State = Eigen::Matrix<double, 7, 1>;
  const auto rate = [&](const State& y) {
    const Vector3d w = y.tail<3>();
    const Quaterniond q(y[0], y[1], y[2], y[3]), spin(0, w.x(), w.y(), w.z()), turn = q * spin;
    State slope;
    slope << turn.w() / 2, turn.vec() / 2, -w.cross(inertia.cwiseProduct(w)).cwiseQuotient(inertia);
    return slope;
  };
  State y;
  y << start.q.w(), start.q.vec(), start.q.conjugate() * start.w;
  constexpr int steps = 20000;
  const double h = t / steps;
  for (int n = 0; n < steps; ++n) {
    const State a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b), d = rate(y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  const Quaterniond q(y[0], y[1], y[2], y[3]);
  return {q, q * Vector3d(y.tail<3>())};
}

void expect_near(const Attitude& actual, const Attitude& expected, double tolerance) {
  EXPECT_LE((actual.q.toRotationMatrix() - expected.q.toRotationMatrix()).norm(), tolerance);
  EXPECT_LE((actual.w - expected.w).norm(), tolerance * expected.w.norm());
}

TEST(FreeTop, moves_as_eulers_equations_whichever_axis_is_the_middle_one) {
  std::array<double, 3> moments = {1, 1.7, 2.5};
  do {
    for (const double t : {0.0, 0.3, 2.0, 9.0}) {
      const Vector3d inertia(moments.data());
      SCOPED_TRACE(::testing::Message() << inertia.transpose() << " after " << t);
      expect_near(free_top(inertia, start, t), integrated(inertia, t), 1e-9);
    }
  } while (std::next_permutation(moments.begin(), moments.end()));
}

TEST(FreeTop, precesses_regularly_about_any_axis_of_symmetry) {
  for (const int axis : {0, 1, 2}) {
    Vector3d inertia(2, 2, 2);
    inertia[axis] = 0.6;
    expect_near(free_top(inertia, start, 4), integrated(inertia, 4), 1e-10);
  }
}

TEST(FreeTop, spins_steadily_where_all_moments_are_equal) {
  const Attitude end = free_top({0.3, 0.3, 0.3}, start, 2);
  EXPECT_LE((end.w - start.w).norm(), 1e-15);
  expect_near(end, integrated({0.3, 0.3, 0.3}, 2), 1e-10);
}

TEST(FreeTop, of_nearly_equal_moments_is_near_the_symmetric_one) {
  expect_near(free_top({2, 2 + 1e-7, 0.6}, start, 3), free_top({2, 2, 0.6}, start, 3), 1e-5);
}

} // namespace
} // namespace dss
