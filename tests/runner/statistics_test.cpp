#include "experiments/base/statistics.hpp"

#include <gtest/gtest.h>
#include <numeric>
#include <stdexcept>

namespace dss {
namespace {

std::vector<double> one_to(int n) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

TEST(Statistics, MedianOfAnEvenSampleIsTheMeanOfTheMiddlePair) {
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({9, 1, 5}), 5);
  EXPECT_THROW(median({}), std::invalid_argument);
}

TEST(Statistics, FiveSamplesGiveNoIntervalAndSixGiveTheirExtremes) {
  EXPECT_FALSE(estimate(one_to(5)).interval);
  EXPECT_FALSE(estimate(one_to(5)).half_width());
  const Estimate six = estimate(one_to(6));
  ASSERT_TRUE(six.interval);
  EXPECT_EQ(six.interval->low, 1);
  EXPECT_EQ(six.interval->high, 6);
}

/// Ranks of the 95 % interval of a median, from tables of the sign test (Conover, Practical
/// Nonparametric Statistics).
TEST(Statistics, IntervalRanksAreThoseOfTheSignTest) {
  const std::pair<int, int> lower_ranks[] = {{6, 1},  {8, 1},  {9, 2},  {11, 2}, {12, 3},
                                             {15, 4}, {20, 6}, {25, 8}, {30, 10}};
  for (const auto& [n, rank] : lower_ranks) {
    const Estimate result = estimate(one_to(n));
    EXPECT_EQ(result.interval->low, rank) << n;
    EXPECT_EQ(result.interval->high, n + 1 - rank) << n;
  }
}

TEST(Statistics, HalfWidthIsRelativeToTheMedian) {
  EXPECT_DOUBLE_EQ(*estimate({98, 99, 100, 100, 101, 102}).half_width(), 0.02);
}

/// U = 0 of 9 and 9: z = (40.5 - 0.5) / sqrt(9 * 9 * 19 / 12) = 3.532, p = 4.12e-4.
TEST(Statistics, RankSumTestAgreesWithAWorkedExample) {
  std::vector<double> a = one_to(9), b = one_to(9);
  for (double& value : b) value += 100;
  EXPECT_NEAR(rank_sum_p_value(a, b), 4.12e-4, 2e-6);
  EXPECT_EQ(rank_sum_p_value(a, b), rank_sum_p_value(b, a));
}

/// Samples of 7 and 9 with ties of 3, 4, 3 and 2 values: U = 8.5, the ties sum to 114, the variance
/// is 7 * 9 / 12 * (17 - 114 / 240) = 86.75625, z = (23 - 0.5) / 9.31430.
TEST(Statistics, RankSumTestSharesRanksBetweenTies) {
  const std::vector<double> a{1, 2, 2, 3, 3, 3, 4}, b{2, 3, 4, 4, 5, 6, 6, 7, 8};
  EXPECT_NEAR(rank_sum_p_value(a, b), 0.0157076, 1e-7);
  EXPECT_NEAR(rank_sum_p_value(b, a), 0.0157076, 1e-7);
}

TEST(Statistics, RankSumTestNeedsValuesOnBothSides) {
  EXPECT_THROW(rank_sum_p_value(std::vector<double>{}, one_to(9)), std::invalid_argument);
  EXPECT_THROW(rank_sum_p_value(one_to(9), std::vector<double>{}), std::invalid_argument);
}

TEST(Statistics, RankSumTestFindsNothingBetweenEqualSamples) {
  EXPECT_EQ(rank_sum_p_value(one_to(12), one_to(12)), 1);
  const std::vector<double> constant(10, 3.0);
  EXPECT_EQ(rank_sum_p_value(constant, constant), 1);
}

TEST(Statistics, OutliersAreFoundByPlaceAndStayInTheSample) {
  std::vector<double> sample = one_to(10);
  EXPECT_TRUE(outliers(sample).empty());
  sample[4] = 1000;
  EXPECT_EQ(outliers(sample), std::vector<std::size_t>{4});
}

/// The quartiles of 0, 10, ..., 60, x lie between values, at 17.5 and 52.5. So numbers outside
/// -87.5 and 157.5 are outliers.
TEST(Statistics, OutliersLieThreeInterquartileRangesBeyondTheQuartiles) {
  std::vector<double> sample{0, 10, 20, 30, 40, 50, 60, 157.5};
  EXPECT_TRUE(outliers(sample).empty());
  sample[7] = 157.6;
  EXPECT_EQ(outliers(sample), std::vector<std::size_t>{7});
  sample[0] = -87.5;
  EXPECT_EQ(outliers(sample), std::vector<std::size_t>{7});
  sample[0] = -87.6;
  EXPECT_EQ(outliers(sample), (std::vector<std::size_t>{0, 7}));
}

TEST(Statistics, FiveValuesHaveNoOutliersAndSixMay) {
  EXPECT_TRUE(outliers(std::vector<double>{1, 1, 1, 1, 100}).empty());
  EXPECT_EQ(outliers(std::vector<double>{1, 1, 1, 1, 1, 100}), std::vector<std::size_t>{5});
}

} // namespace
} // namespace dss
