#pragma once
/// Statistics of timings (DESIGN.md section 6): medians with order-statistic intervals, ratios of pairs, the rank-sum
/// test.
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace dss {

/// A closed interval.
struct Interval {
  double low = 0, high = 0;
};

/// A median with its 95 % confidence interval; no interval below six samples, where none of 95 % exists.
struct Estimate {
  std::size_t count = 0;
  double median = 0;
  std::optional<Interval> interval;
  /// Half the interval's width relative to the median, or nothing without an interval.
  std::optional<double> half_width() const;
};

/// Smallest number of samples whose extremes enclose the median with 95 %: 1 - 2 / 2^6 = 0.969.
constexpr std::size_t interval_samples = 6;

/// Median of a sample. @throws std::invalid_argument for an empty one
double median(std::vector<double> sample);

/// Median and distribution-free interval from the order statistics x_(k), x_(n+1-k), k the largest with coverage >= 95
/// % by the binomial distribution (Hoefler & Belli, SC'15, rule 5). @throws std::invalid_argument for an empty sample
Estimate estimate(std::vector<double> sample);

/// Two-sided p value of the Mann-Whitney U test, normal approximation with ties and continuity correction; meant for
/// samples of nine or more.
/// @throws std::invalid_argument if a sample is empty
double rank_sum_p_value(std::span<const double> a, std::span<const double> b);

/// Places of samples beyond 3 interquartile ranges of the quartiles: to be flagged, never deleted.
std::vector<std::size_t> outliers(std::span<const double> sample);

} // namespace dss
