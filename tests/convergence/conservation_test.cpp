/// Balances of free bodies with open gaps and large rotations, for every variant: what an
/// evaluation must conserve, and what a run conserves.
#include "solver/model/energy.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace dss::test {
namespace {

using Vector = Eigen::Vector3d;

Vector triple(const double* fields, int first) {
  return {fields[first], fields[first + 1], fields[first + 2]};
}

/// Inertia of an element in global axes.
Eigen::Matrix3d inertia(const Body& body, const double* y) {
  const Eigen::Matrix3d a =
      Eigen::Quaterniond(1 + y[qs], y[qx], y[qy], y[qz]).normalized().toRotationMatrix();
  return a * Vector(body.inertia[0], body.inertia[1], body.inertia[2]).asDiagonal() * a.transpose();
}

/// A vector sum, and the sum of its terms' magnitudes, which rounding is relative to.
struct Balance {
  Vector sum = Vector::Zero();
  double magnitudes = 0;
  void add(const Vector& v) { sum += v, magnitudes += v.norm(); }
  double relative() const { return sum.norm() / magnitudes; }
};

template <class Visit>
void each(const Problem& problem, const State& state, Visit&& visit) {
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec3 rest = rest_position(problem, row, x);
    const double* y = &state[e * field_count];
    visit(e, problem.bodies[std::size_t(row.body)], y,
          Vector(rest[0], rest[1], rest[2]) + triple(y, ux));
  });
}

struct Momenta {
  Balance linear, angular;
};
Momenta momenta(const Problem& problem, const State& state) {
  Momenta m;
  each(problem, state, [&](std::size_t, const Body& body, const double* y, const Vector& place) {
    const Vector p = body.mass * triple(y, vx);
    m.linear.add(p);
    m.angular.add(place.cross(p) + inertia(body, y) * triple(y, wx));
  });
  return m;
}

class EveryFreeBody : public testing::TestWithParam<std::string> {
protected:
  const Plugin& plugin = load_variant(GetParam());
};

TEST_P(EveryFreeBody, feels_no_net_force_and_no_net_moment_from_its_own_links_damping_included) {
  const Problem box = fixture::make_block(6, 5, 3, LinkLaw::material, 1);
  const State state = fixture::random_state(box, 11),
              rates = VariantRun{plugin, box, *find_method("rk4")}.derivative(state);
  Balance force, moment;
  each(box, state, [&](std::size_t e, const Body& body, const double* y, const Vector& place) {
    const double* r = &rates[e * field_count];
    const Eigen::Matrix3d j = inertia(body, y);
    const Vector f = body.mass * triple(r, vx), w = triple(y, wx);
    force.add(f);
    moment.add(place.cross(f));
    moment.add(j * triple(r, wx) + w.cross(j * w));
  });
  EXPECT_LE(force.relative(), 1e-13);
  EXPECT_LE(moment.relative(), 1e-13);
}

TEST_P(EveryFreeBody, keeps_its_linear_momentum_over_10000_steps) {
  const Problem box = fixture::make_tumbling_box(1);
  State start = initial_state(box);
  for (const Method& method : distinct_methods(plugin)) {
    const Momenta before = momenta(box, start),
                  after = momenta(box, VariantRun{plugin, box, method}.after(start, 10000));
    EXPECT_LE((after.linear.sum - before.linear.sum).norm(), 2e-13 * before.linear.magnitudes)
        << method.name;
  }
}

TEST_P(EveryFreeBody, loses_angular_momentum_and_energy_at_the_order_of_the_method) {
  const Problem box = fixture::make_tumbling_box(0);
  State start = initial_state(box);
  const Momenta before = momenta(box, start);
  const double energy = total_energy(box, start);
  for (const Method& method : distinct_methods(plugin)) {
    const auto errors = [&](int refinement) {
      const State end =
          VariantRun{plugin, box, method, Model::spatial, Precision::f64, 1, 4e-4 / refinement}
              .after(start, 250 * refinement);
      return std::pair((momenta(box, end).angular.sum - before.angular.sum).norm(),
                       std::abs(total_energy(box, end) - energy));
    };
    if (method.order > 4) continue; // loses less than rounding
    const auto coarse = errors(4), fine = errors(8);
    EXPECT_GE(std::log2(coarse.first / fine.first), method.order - 0.2)
        << "angular momentum, " << method.name;
    EXPECT_GE(std::log2(coarse.second / fine.second), method.order - 0.2)
        << "energy, " << method.name;
  }
}

/// Velocity Verlet conserves (v / omega)^2 + (1 - (h omega / 2)^2) x^2 of an oscillator, except for
/// rounding.
TEST(MillionSteps, of_velocity_verlet_leave_the_energy_of_an_undamped_pair_without_a_trend) {
  const Problem pair = fixture::make_pair(LinkLaw::paper, 0);
  const double omega = std::sqrt(2 * pair.bodies[0].axis[0].k_normal / pair.bodies[0].mass),
               h_omega = 0.1;
  State start(2 * field_count, 0);
  start[ux] = -1e-6, start[field_count + ux] = 1e-6;
  const auto kept = [&](const State& state) {
    const double x = state[field_count + ux], v = state[field_count + vx] / omega;
    return v * v + (1 - h_omega * h_omega / 4) * x * x;
  };
  for (const char* variant : {"scalar", "auto"}) {
    const VariantRun run{load_variant(variant), pair,           *find_method("velocity_verlet"),
                         Model::spatial,        Precision::f64, 1,
                         h_omega / omega};
    EXPECT_NEAR(kept(run.after(start, 1'000'000)) / kept(start), 1, 1e-9) << variant;
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryFreeBody, testing::ValuesIn(usable_variants()),
                         name_of_variant);

TEST(VelocityVerlet, shows_no_energy_trend_over_100000_steps_of_the_fastest_variant) {
  const Problem box = fixture::make_tumbling_box(0);
  const Method& method = *find_method("velocity_verlet");
  State state = initial_state(box);
  const double start = total_energy(box, state);
  const auto run =
      load_variant("auto").create({box, method, Model::spatial, Precision::f64, box.dt, 1});
  run->write(0, state);
  constexpr int samples = 200;
  std::vector<double> error;
  for (int n = 0; n < samples; ++n) {
    run->advance(100'000 / samples, signal_rows(box, method, box.dt, long(n) * (100'000 / samples),
                                                100'000 / samples));
    run->read(0, state);
    error.push_back(total_energy(box, state) / start - 1);
  }
  double early = 0, late = 0, largest = 0;
  for (int n = 0; n < samples / 4; ++n)
    early += error[std::size_t(n)], late += error[std::size_t(samples - 1 - n)];
  for (const double e : error) largest = std::max(largest, std::abs(e));
  EXPECT_LT(largest, 1e-5);
  EXPECT_LT(std::abs(late - early) / (samples / 4), 0.2 * largest);
}

} // namespace
} // namespace dss::test
