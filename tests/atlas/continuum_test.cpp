#include "experiments/studies/continuum/beam_theory.hpp"
#include "experiments/studies/continuum/continuum_study.hpp"
#include "solver/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

TEST(CantileverFrequencies, of_a_slender_beam_are_euler_and_bernoullis) {
  const std::vector<double> found = cantilever_frequencies({1, 1e9, 1, 1e-9, 1}, 3);
  // Squares of the roots of cos x cosh x = -1.
  for (std::size_t n = 0; n < 3; ++n) {
    const double root = std::sqrt(found[n]);
    EXPECT_NEAR(std::cos(root) * std::cosh(root), -1, 1e-4 * std::cosh(root)) << n;
  }
  EXPECT_NEAR(found[0], 3.516015, 1e-5);
}

TEST(CantileverFrequencies, end_at_the_cut_off) {
  EXPECT_THROW(cantilever_frequencies({1, 10, 1, 0.05, 1}, 20), InputError);
}

TEST(Richardson, finds_the_order_and_the_limit_of_a_power) {
  const std::vector<double> spacing = {0.4, 0.17, 0.1};
  std::vector<double> figures;
  for (const double h : spacing) figures.push_back(7 - 3 * std::pow(h, 1.7));
  const Richardson found = richardson(spacing, figures);
  EXPECT_NEAR(found.order, 1.7, 1e-9);
  EXPECT_NEAR(found.limit, 7, 1e-9);
  EXPECT_TRUE(std::isnan(richardson(spacing, {1, 2, 1}).order));
}

} // namespace
} // namespace dss
