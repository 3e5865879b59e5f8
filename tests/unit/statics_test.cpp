#include "solver/error.hpp"
#include "solver/statics/equilibrium.hpp"
#include "solver/statics/held.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dss {
namespace {

constexpr LinkLaw laws[] = {LinkLaw::paper, LinkLaw::material};

/// A row of elements, the first one held.
Problem held_row(int n, LinkLaw law) {
  Problem problem = fixture::make_block(n, 1, 1, law);
  problem.clamps = {{0, dof_all}};
  return problem;
}

Load end_load(const Problem& problem, const Vec3& force, const Vec3& torque = {}) {
  return {{problem.lattice.element_count - 1}, force, torque, {}};
}

/// A block, held on one side and pulled at the other.
Problem held_block(LinkLaw law, double load = 1) {
  Problem problem = fixture::make_block(3, 2, 2, law);
  for (std::size_t e = 0; e < problem.lattice.element_count; e += 3)
    problem.clamps.push_back({e, dof_all});
  problem.loads = {{{2, 5}, {20 * load, -30 * load, 50 * load}, {0.1 * load, 0, 0.2 * load}, {}}};
  return problem;
}

std::vector<double> solved(const Problem& problem, Rotation law,
                           SolverKind kind = SolverKind::direct,
                           Preconditioner preconditioner = Preconditioner::incomplete_cholesky) {
  StaticSystem system(problem, law);
  const Equilibrium found =
      find_equilibrium(system, {.solver = kind, .preconditioner = preconditioner});
  EXPECT_TRUE(found.is_found) << found.reason;
  EXPECT_LT(found.residual, 1e-9);
  return system.fields(found.state);
}

/// Largest difference of displacements over the largest displacement.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    if (n % field_count <= uz)
      most = std::max(most, std::abs(a[n] - b[n])), largest = std::max(largest, std::abs(b[n]));
  return most / largest;
}

double of_end(const std::vector<double>& state, Field field) {
  return state[state.size() - field_count + field];
}

std::string refusal(const Problem& problem, SolverKind kind = SolverKind::automatic) {
  StaticSystem system(problem, Rotation::linearised);
  try {
    find_equilibrium(system, {.solver = kind});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Statics, stiffness_of_links_at_rest_is_the_slope_of_the_oracles_forces) {
  for (const LinkLaw law : laws) {
    Problem problem = held_block(law);
    problem.stabilization = {20, 0.5, 0.3, 0.01};
    const StaticSystem system(problem);
    const SparseMatrix exact = system.stiffness_at_rest();
    EXPECT_LT((exact - system.tangent(system.rest())).norm(), 1e-10 * exact.norm());
  }
}

TEST(Statics, tangent_of_a_loaded_state_is_the_slope_of_its_forces) {
  for (const LinkLaw law : laws) {
    Problem problem = held_block(law);
    problem.loads.front().torque = {}; // a torque about a fixed axis has no potential
    StaticSystem system(problem);
    const auto state = find_equilibrium(system).state;
    std::mt19937_64 generator(3);
    std::normal_distribution<double> normal;
    const Eigen::VectorXd step =
        1e-6 * Eigen::VectorXd::NullaryExpr(system.size(), [&] { return normal(generator); });
    auto ahead = state, behind = state;
    system.move(ahead, step);
    system.move(behind, -step);
    const Eigen::VectorXd slope =
        ((system.unbalanced(behind) - system.unbalanced(ahead)) / 2).cast<double>();
    const Eigen::VectorXd expected = system.tangent(state).selfadjointView<Eigen::Lower>() * step;
    EXPECT_LT((slope - expected).norm(), 1e-9 * expected.norm());
  }
}

/// Sum over the free degrees of freedom.
double work(const StaticSystem::Vector& forces, const Eigen::VectorXd& motion) {
  return double(forces.dot(motion.cast<StaticSystem::Real>()));
}

// The matrix holds the symmetric part of the derivative, which alone does work on its own motion.
TEST(Statics, tangent_of_a_moving_state_is_the_slope_by_displacements_and_velocities) {
  for (const Rotation rotation : {Rotation::quaternion, Rotation::small, Rotation::linearised})
    for (const Problem& problem :
         {fixture::make_everything(), fixture::pressed(fixture::make_everything())}) {
      constexpr double share = 1e-3;
      StaticSystem system(problem, rotation);
      const std::vector<double> fields = fixture::random_state(problem, 5, 2e-4, 0.1, 0.1);
      auto state = system.inside(fields);
      for (std::size_t n = 0; n < state.size(); ++n)
        if (n % field_count >= vx && (n % field_count < qs || n % field_count > qz))
          state[n] = fields[n];
      std::mt19937_64 generator(3);
      std::normal_distribution<double> normal;
      const Eigen::VectorXd step =
          1e-6 * Eigen::VectorXd::NullaryExpr(system.size(), [&] { return normal(generator); });
      const auto moved = [&](double sign) {
        auto there = state;
        system.move(there, sign * share * step);
        for (Eigen::Index n = 0; n < step.size(); ++n) {
          const std::size_t dof = system.dofs().dof[std::size_t(n)];
          const std::size_t field = dof % 6 < 3 ? vx + dof % 6 : wx + dof % 6 - 3;
          there[dof / 6 * field_count + field] += sign * step[n];
        }
        return system.unbalanced(there);
      };
      const double slope = work((moved(-1) - moved(1)) / 2, step);
      const SparseMatrix tangent = system.tangent(state, {share, 1});
      const double expected = step.dot(tangent.selfadjointView<Eigen::Lower>() * step);
      // Small rotations have pressures whose forces are not quite the gradient of an energy.
      const bool is_gradient = rotation != Rotation::small || !problem.has_pressure();
      EXPECT_NEAR(slope, expected, (is_gradient ? 1e-9 : 1e-3) * std::abs(expected))
          << name(rotation);
    }
}

TEST(Statics, bar_under_an_end_load_stretches_by_one_gap_a_link) {
  constexpr int n = 7;
  for (const LinkLaw law : laws) {
    Problem problem = held_row(n, law);
    problem.loads = {end_load(problem, {5, 0, 0})};
    const double expected = 5 * (n - 1) / problem.bodies.front().axis[0].k_normal;
    for (const Rotation rotation : {Rotation::linearised, Rotation::quaternion, Rotation::small})
      EXPECT_NEAR(of_end(solved(problem, rotation), ux), expected, 1e-13 * expected);
  }
}

TEST(Statics, cantilever_bends_by_the_sum_over_its_links) {
  constexpr int n = 9;
  for (const LinkLaw law : laws) {
    Problem problem = held_row(n, law);
    problem.loads = {end_load(problem, {0, 0, 2})};
    const Body& body = problem.bodies.front();
    const AxisConstants& link = body.axis[0];
    const double bending = law == LinkLaw::paper ? link.k_rot[0] : link.k_rot[1];
    double expected =
        0; // for each link: its shear, and its turn times the arm from its face to the end's centre
    for (int i = 0; i < n - 1; ++i) {
      const double arm = body.edge[0] * (n - 1 - i - 0.5);
      expected += 2 / link.k_shear[2] + 2 * arm * arm / bending;
    }
    for (const SolverKind kind : {SolverKind::direct, SolverKind::cg})
      for (const Preconditioner preconditioner :
           {Preconditioner::incomplete_cholesky, Preconditioner::block_jacobi})
        EXPECT_NEAR(of_end(solved(problem, Rotation::linearised, kind, preconditioner), uz),
                    expected, 1e-11 * expected);
  }
}

TEST(Statics, end_torque_rolls_a_row_up_as_its_springs_say) {
  constexpr int n = 9;
  Problem problem = held_row(n, LinkLaw::paper);
  const Body& body = problem.bodies.front();
  const double angle = 0.2,
               kt = body.axis[0].k_rot[0]; // a link turns by `angle` at 2 kt sin(angle / 2)
  problem.loads = {end_load(problem, {}, {0, 0, 2 * kt * std::sin(angle / 2)})};
  double x = 0, y = 0; // half edges of neighbours meet at their faces
  for (int i = 0; i < n - 1; ++i)
    for (const double turned : {i * angle, (i + 1) * angle})
      x += body.edge[0] / 2 * std::cos(turned), y += body.edge[0] / 2 * std::sin(turned);
  const std::vector<double> state = solved(problem, Rotation::quaternion);
  EXPECT_NEAR(of_end(state, ux), x - (n - 1) * body.edge[0], 1e-11);
  EXPECT_NEAR(of_end(state, uy), y, 1e-11);
  EXPECT_NEAR(of_end(state, qz), std::sin((n - 1) * angle / 2), 1e-11);
}

TEST(Statics, all_solvers_agree_under_small_loads) {
  for (const LinkLaw law : laws) {
    const Problem problem = held_block(law, 1e-9);
    const std::vector<double> direct = solved(problem, Rotation::linearised);
    EXPECT_LT(difference(solved(problem, Rotation::linearised, SolverKind::cg), direct), 1e-11);
    EXPECT_LT(difference(solved(problem, Rotation::quaternion), direct), 1e-8);
    EXPECT_LT(difference(solved(problem, Rotation::quaternion, SolverKind::cg), direct), 1e-8);
    EXPECT_LT(difference(solved(problem, Rotation::small), direct), 1e-8);
  }
}

TEST(Statics, newtons_state_differs_from_the_linear_one_by_the_square_of_the_load) {
  for (const LinkLaw law : laws) {
    double last = 0;
    for (const double load : {0.01, 0.02}) {
      const Problem problem = held_block(law, load);
      const double now =
          difference(solved(problem, Rotation::linearised), solved(problem, Rotation::quaternion));
      if (last > 0) {
        EXPECT_NEAR(now / last, 2, 0.1); // for a relative difference
      }
      last = now;
    }
  }
}

TEST(Statics, every_term_is_in_balance) {
  Problem problem = fixture::make_everything();
  problem.steps = 37;
  const std::vector<double> state = solved(problem, Rotation::quaternion);
  // Without velocities and with the signals at the end of the run, no force is left on what is
  // free.
  reference::Dynamics<double> dynamics(problem);
  std::vector<double> rates(state.size()), signals;
  const double end = problem.dt * double(problem.steps);
  for (const Signal& signal : problem.frame_acceleration) signals.push_back(signal(end));
  for (const Load& load : problem.loads) signals.push_back(load.signal(end));
  dynamics.rates(state, signals, rates);
  for (std::size_t n = 0; n < rates.size(); ++n) {
    const bool is_half_clamped =
        n / field_count == 1; // one turn of that box is clamped, which no scene may do
    EXPECT_NEAR(is_half_clamped ? 0 : rates[n], 0, 1e-8) << n;
  }
  // held_still is the same problem with the signals of its end, constant.
  EXPECT_LT(difference(solved(held_still(problem), Rotation::quaternion), state), 1e-12);
}

TEST(Statics, without_loads_stays_at_rest) {
  Problem problem = held_block(LinkLaw::material);
  problem.loads.clear();
  for (const double field : solved(problem, Rotation::quaternion)) EXPECT_EQ(field, 0);
}

TEST(Statics, names_the_body_that_is_free_to_move) {
  Problem problem = held_block(LinkLaw::material);
  problem.clamps.clear();
  EXPECT_NE(refusal(problem).find("body \"block\" is free to"), std::string::npos);
  problem.clamps = {{0, dof_ux | dof_uy | dof_uz}};
  EXPECT_NE(refusal(problem).find("is free to turn about"), std::string::npos);
  problem.clamps = {{0, dof_all & ~dof_uy}};
  EXPECT_NE(refusal(problem).find("is free to move along y"), std::string::npos);
  problem.clamps = {
      {0, dof_ux | dof_uy | dof_uz}, {2, dof_uy | dof_uz}, {4, dof_uz}}; // three points
  EXPECT_EQ(refusal(problem), "");
  problem.clamps.clear();
  problem.stabilization = {1, 0, 0, 0};
  EXPECT_EQ(refusal(problem), "");
  EXPECT_EQ(why_not_held(fixture::make_everything()), "");
}

TEST(Statics, names_an_element_that_links_do_not_hold) {
  Problem problem = held_row(5, LinkLaw::paper);
  for (AxisConstants& axis : problem.bodies.front().axis) axis.k_rot = {};
  problem.loads = {end_load(problem, {1, 0, 0})};
  EXPECT_NE(refusal(problem, SolverKind::direct).find("(a mechanism"), std::string::npos);
  // If no load drives it, conjugate gradients pass it by and say so.
  StaticSystem system(problem, Rotation::linearised);
  const Equilibrium found = find_equilibrium(system);
  EXPECT_NE(found.note.find("(a mechanism"), std::string::npos);
  EXPECT_NEAR(of_end(system.fields(found.state), ux), 4 / problem.bodies.front().axis[0].k_normal,
              1e-15);
}

TEST(Statics, says_so_where_loads_buckle_a_column) {
  constexpr int n = 12;
  Problem problem = held_row(n, LinkLaw::material);
  const Body& body = problem.bodies.front();
  const double length = body.edge[0] * (n - 1), bending = body.axis[0].k_rot[2] * body.edge[0];
  const double critical =
      M_PI * M_PI * bending /
      (4 * length * length); // Euler's; shear and discreteness change it by some per cent
  problem.loads = {end_load(problem, {-0.5 * critical, 0, 0})};
  EXPECT_LT(of_end(solved(problem, Rotation::quaternion), ux), 0);
  problem.loads = {end_load(problem, {-1.5 * critical, 0, 0})};
  StaticSystem system(problem);
  EXPECT_THROW(find_equilibrium(system), UnstableError);
}

} // namespace
} // namespace dss
