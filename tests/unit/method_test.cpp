#include "solver/numerics/method.hpp"
#include "solver/numerics/stability.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace dss {
namespace {

/// The Butcher table that a Runge-Kutta method's increment form amounts to; row `stages` holds the weights.
using Table = std::vector<std::vector<double>>;

Table butcher_table(const Method& method) {
  Table w(std::size_t(method.stages) + 1, std::vector<double>(std::size_t(method.stages)));
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    for (std::size_t m = 1; m <= s; ++m)
      for (std::size_t j = 0; j < m; ++j) w[s + 1][j] += method.alpha[s][m] * w[m][j];
    w[s + 1][s] += method.beta[s];
  }
  return w;
}

TEST(Methods, are_found_by_their_own_unique_name_and_unknown_names_are_not) {
  std::set<std::string_view> names;
  for (const Method& method : methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_EQ(find_method(method.name), &method);
  }
  EXPECT_EQ(names.count("rk4"), 1u);
  EXPECT_EQ(names.count("velocity_verlet"), 1u);
  EXPECT_EQ(find_method("rk5"), nullptr);
  EXPECT_EQ(find_method(""), nullptr);
}

TEST(Methods, evaluate_each_stage_at_the_time_that_its_state_stands_for) {
  for (const Method& method : methods()) {
    if (method.family != Method::Family::runge_kutta) continue;
    const Table w = butcher_table(method);
    for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
      double sum = 0;
      for (const double weight : w[s]) sum += weight;
      EXPECT_NEAR(sum, method.node[s], 1e-15) << method.name << " stage " << s;
    }
  }
}

TEST(Methods, of_the_runge_kutta_family_meet_the_order_conditions_of_their_declared_order) {
  for (const Method& method : methods()) {
    if (method.family != Method::Family::runge_kutta) continue;
    const Table w = butcher_table(method);
    const auto stages = std::size_t(method.stages);
    const auto& b = w[stages];
    const auto& c = method.node;
    // Sums over rooted trees up to order 4 (Hairer, Norsett, Wanner I, table II.2.2).
    std::array<double, 8> sum{};
    for (std::size_t i = 0; i < stages; ++i) {
      double ac = 0, acc = 0, aac = 0;
      for (std::size_t j = 0; j < i; ++j) {
        ac += w[i][j] * c[j];
        acc += w[i][j] * c[j] * c[j];
        for (std::size_t k = 0; k < j; ++k) aac += w[i][j] * w[j][k] * c[k];
      }
      const std::array<double, 8> terms = {1, c[i], c[i] * c[i], ac, c[i] * c[i] * c[i], c[i] * ac, acc, aac};
      for (std::size_t t = 0; t < terms.size(); ++t) sum[t] += b[i] * terms[t];
    }
    const std::array<double, 8> exact = {1, 1. / 2, 1. / 3, 1. / 6, 1. / 4, 1. / 8, 1. / 12, 1. / 24};
    const std::array<std::size_t, 5> conditions = {0, 1, 2, 4, 8};
    ASSERT_LE(method.order, 4) << method.name << ": conditions beyond order 4 are not listed here";
    for (std::size_t t = 0; t < conditions[std::size_t(method.order)]; ++t)
      EXPECT_NEAR(sum[t], exact[t], 1e-15) << method.name << " condition " << t;
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
