#include "solver/numerics/method.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace dss {
namespace {

/// The Butcher table of a Runge-Kutta method in increment form. Row `stages` holds the weights.
using Table = std::vector<std::vector<double>>;

Table butcher_table(const Method& method) {
  using Row = std::vector<long double>; // large coefficients cancel
  std::vector<Row> w(std::size_t(method.stages) + 1, Row(std::size_t(method.stages)));
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    for (std::size_t m = 1; m <= s; ++m)
      for (std::size_t j = 0; j < m; ++j) w[s + 1][j] += method.alpha[s][m] * w[m][j];
    w[s + 1][s] += method.beta[s];
  }
  Table table;
  for (const Row& row : w) table.emplace_back(row.begin(), row.end());
  return table;
}

TEST(Methods, are_found_by_their_own_unique_name_and_unknown_names_are_not) {
  std::set<std::string_view> names;
  for (const Method& method : methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_EQ(find_method(method.name), &method);
  }
  for (const char* name : {"rk4", "velocity_verlet", "smoothed_verlet", "midpoint",
                           "symplectic_euler", "dopri5", "verner8", "rkc2"})
    EXPECT_EQ(names.count(name), 1u) << name;
  EXPECT_EQ(find_method("smoothed_verlet")->real_limit, 1.75); // of smoothing 3/4
  EXPECT_EQ(find_method("rk5"), nullptr);
  EXPECT_EQ(find_method(""), nullptr);
}

TEST(Methods, may_be_named_with_a_radius) {
  const Method *half = find_method("generalized_alpha:0.5"),
               *listed = find_method("generalized_alpha:0.8");
  ASSERT_NE(half, nullptr);
  EXPECT_EQ(half->name, "generalized_alpha:0.5");
  EXPECT_EQ(half->node[1], 2. / 3);
  EXPECT_EQ(half->rate_share, 2.5 / 3);
  EXPECT_EQ(find_method("generalized_alpha:0.5"), half); // executors refer to it
  EXPECT_EQ(listed->node, find_method("generalized_alpha")->node);
  for (const char* wrong : {"", "x", "1.01", "-0.1", "nan", "inf", "0.5 ", "0.5:0.5", ".5", "1.",
                            "5e-1", "-0", "0.1.2"}) {
    const std::string name = std::string(with_radius) + wrong;
    EXPECT_EQ(find_method(name), nullptr) << name;
    EXPECT_NE(why_no_method(name).find("from 0 to 1"), std::string::npos) << name;
  }
}

TEST(Methods, evaluate_each_stage_at_the_time_that_its_state_stands_for) {
  for (const Method& method : methods()) {
    if (method.family != Method::Family::runge_kutta) continue;
    const Table w = butcher_table(method);
    for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
      double sum = 0;
      for (const double weight : w[s]) sum += weight;
      EXPECT_NEAR(sum, method.node[s], 1e-14) << method.name << " stage " << s;
    }
  }
}

/// A rooted tree: the list of the subtrees of its root (Hairer, Norsett, Wanner I, section II.2).
struct Tree {
  std::vector<Tree> children;
  int order() const {
    int sum = 1;
    for (const Tree& child : children) sum += child.order();
    return sum;
  }
  double density() const {
    double product = order();
    for (const Tree& child : children) product *= child.density();
    return product;
  }
  /// Elementary weight of stage i: the product over the subtrees of sum_j a_ij times their weight.
  double weight(const Table& a, std::size_t i) const {
    double product = 1;
    for (const Tree& child : children) {
      double sum = 0;
      for (std::size_t j = 0; j < a[i].size(); ++j)
        if (a[i][j] != 0) sum += a[i][j] * child.weight(a, j);
      product *= sum;
    }
    return product;
  }
};

/// All trees of an order. `smaller` has the trees of lower orders, sorted by order. Each tree takes
/// its subtrees from there, the last ones first.
std::vector<Tree> trees_of(int order) {
  std::vector<Tree> smaller;
  for (int n = 1; n < order; ++n)
    for (Tree& tree : trees_of(n)) smaller.push_back(std::move(tree));
  std::vector<Tree> found;
  const auto add = [&](const auto& self, Tree tree, int left, std::size_t last) -> void {
    if (left == 0) return found.push_back(tree);
    for (std::size_t n = 0; n < last; ++n)
      if (smaller[n].order() <= left) {
        Tree longer = tree;
        longer.children.push_back(smaller[n]);
        self(self, longer, left - smaller[n].order(), n + 1);
      }
  };
  add(add, Tree{}, order - 1, smaller.size());
  return found;
}

TEST(RootedTrees, are_as_many_as_known) {
  for (const auto& [order, count] : {std::pair{1, 1}, {2, 1}, {3, 2}, {4, 4}, {5, 9}, {6, 20}})
    EXPECT_EQ(trees_of(order).size(), std::size_t(count)) << order;
}

TEST(Methods, of_the_runge_kutta_family_meet_the_order_conditions_of_their_order_and_no_more) {
  for (const Method& method : methods()) {
    if (method.family != Method::Family::runge_kutta) continue;
    const Table w = butcher_table(method);
    const auto error = [&](const Tree& tree) {
      double sum = 0;
      for (std::size_t i = 0; i < std::size_t(method.stages); ++i)
        sum += w.back()[i] * tree.weight(w, i);
      return std::abs(sum - 1 / tree.density());
    };
    for (int order = 1; order <= method.order; ++order)
      for (const Tree& tree : trees_of(order))
        EXPECT_LT(error(tree), 1e-14) << method.name << " order " << order;
    double next = 0;
    for (const Tree& tree : trees_of(method.order + 1)) next = std::max(next, error(tree));
    EXPECT_GT(next, 1e-6) << method.name;
  }
}

TEST(Dopri5,
     with_an_error_stage_takes_the_same_step_and_estimates_the_error_by_a_method_of_fourth_order) {
  const Table plain = butcher_table(*find_method("dopri5")), w = butcher_table(dopri5_adaptive());
  ASSERT_EQ(w.size(), 8u);
  for (std::size_t s = 0; s < plain.size(); ++s)
    for (std::size_t j = 0; j < 6; ++j) EXPECT_EQ(w[s][j], plain[s][j]) << s << ' ' << j;
  EXPECT_NEAR(dopri5_adaptive().node.back(), 1, 1e-14);
  const auto error = [&](const Tree& tree) { // of the step minus the estimate
    double sum = 0;
    for (std::size_t i = 0; i < 7; ++i)
      sum += ((i < 6 ? plain.back()[i] : 0) - w.back()[i]) * tree.weight(w, i);
    return std::abs(sum - 1 / tree.density());
  };
  for (int order = 1; order <= 4; ++order)
    for (const Tree& tree : trees_of(order)) EXPECT_LT(error(tree), 1e-14) << order;
  double next = 0;
  for (const Tree& tree : trees_of(5)) next = std::max(next, error(tree));
  EXPECT_GT(next, 1e-6);
}

TEST(Rkc2, has_a_limit_that_grows_with_the_square_of_its_stages) {
  for (int stages = 2; stages <= 20; ++stages) {
    const Method method = rkc2(stages);
    EXPECT_NEAR(mode_step_limit(method, 0, 1), method.real_limit, 1e-6 * method.real_limit)
        << stages;
    EXPECT_GE(method.real_limit, 0.65 * (stages * stages - 1)) << stages;
    EXPECT_EQ(method.stages, stages);
  }
}

/// One step of the oracle on an undamped mode with h omega = 0.5, as a matrix of (x, v / omega).
std::array<std::array<double, 2>, 2> step_on_a_mode(const Method& method) {
  const Problem pair = fixture::make_pair(LinkLaw::paper, 0);
  const double omega = std::sqrt(2 * pair.bodies[0].axis[0].k_normal / pair.bodies[0].mass),
               size = 1e-6;
  std::array<std::array<double, 2>, 2> matrix{};
  for (const std::size_t column : {0u, 1u}) {
    std::vector<double> state(2 * field_count, 0);
    const std::size_t field = column == 0 ? ux : vx;
    state[field_count + field] = column == 0 ? size : size * omega;
    state[field] = -state[field_count + field];
    Oracle<long double> oracle(pair, method, 0.5 / omega);
    oracle.write(state);
    EXPECT_FALSE(oracle.advance(1));
    oracle.read(state);
    matrix[0][column] = state[field_count + ux] / size;
    matrix[1][column] = state[field_count + vx] / (size * omega);
  }
  return matrix;
}

TEST(Methods, are_symplectic_and_keep_an_energy_bounded_where_they_say_so_and_nowhere_else) {
  constexpr double rounding = 1e-12;
  for (const Method* method : all_methods()) {
    const auto [position, velocity] = step_on_a_mode(*method);
    const double determinant = position[0] * velocity[1] - position[1] * velocity[0];
    const double half_trace = (position[0] + velocity[1]) / 2,
                 rest = half_trace * half_trace - determinant;
    const double radius =
        rest < 0 ? std::sqrt(determinant) : std::abs(half_trace) + std::sqrt(rest);
    EXPECT_EQ(std::abs(determinant - 1) < rounding, method->is_symplectic)
        << method->name << " " << determinant;
    EXPECT_EQ(std::abs(radius - 1) < rounding, method->keeps_energy_bounded)
        << method->name << " " << radius;
  }
}

TEST(Methods, declare_the_stability_limits_that_their_tables_have) {
  for (const Method& method : methods()) {
    EXPECT_NEAR(mode_step_limit(method, 1, 0), method.imaginary_limit, 1e-6) << method.name;
    EXPECT_NEAR(mode_step_limit(method, 0, 1), method.real_limit, 1e-6) << method.name;
  }
}

} // namespace
} // namespace dss
