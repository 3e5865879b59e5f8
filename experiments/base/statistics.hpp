#pragma once
/// Statistics of timings (DESIGN.md section 6): medians with confidence intervals, outliers, and
/// the rank-sum test. In this file a sample is a list of numbers.
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace dss {

/// A closed interval.
struct Interval {
  double low = 0, high = 0;
};

/// A median with its 95 % confidence interval. Fewer than six numbers have no such interval.
struct Estimate {
  std::size_t count = 0;
  double median = 0;
  std::optional<Interval> interval;
  /// Half the width of the interval, relative to the median; empty without an interval.
  std::optional<double> half_width() const;
};

/// Smallest number of values whose extremes enclose the median with 95 %: 1 - 2 / 2^6 = 0.969.
constexpr std::size_t interval_samples = 6;

/// Median of a sample. @throws std::invalid_argument for an empty sample
double median(std::vector<double> sample);

/// Median and a distribution-free interval: the order statistics x_(k) and x_(n+1-k), with the
/// largest k whose coverage is at least 95 % by the binomial distribution. Source: Hoefler & Belli,
/// SC'15, rule 5.
/// @throws std::invalid_argument for an empty sample
Estimate estimate(std::vector<double> sample);

/// Smallest samples for which the normal approximation of the rank-sum test holds.
constexpr std::size_t rank_sum_samples = 9;

/// Two-sided p value of the Mann-Whitney U test, by the normal approximation with ties and
/// continuity correction. Use it for at least rank_sum_samples values in each sample.
/// @throws std::invalid_argument if a sample is empty
double rank_sum_p_value(std::span<const double> a, std::span<const double> b);

/// Indices of values more than 3 interquartile ranges outside the quartiles. Outliers are flagged,
/// never deleted.
std::vector<std::size_t> outliers(std::span<const double> sample);

} // namespace dss
