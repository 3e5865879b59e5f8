#include "experiments/base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dss {
namespace {

/// Index k of the lower end of the interval: the largest k with P(Binomial(n, 1/2) <= k - 1) <=
/// 0.025.
std::size_t order_of_lower_bound(std::size_t n) {
  double term = std::pow(0.5, double(n)), cumulated = term;
  std::size_t k = 0;
  while (cumulated <= 0.025) {
    ++k;
    term *= double(n - k + 1) / double(k);
    cumulated += term;
  }
  return k;
}

double quantile(const std::vector<double>& sorted, double fraction) {
  const double place = fraction * double(sorted.size() - 1);
  const std::size_t below = std::size_t(place), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - double(below)) * (sorted[above] - sorted[below]);
}

} // namespace

std::optional<double> Estimate::half_width() const {
  if (!interval) return std::nullopt;
  return 0.5 * (interval->high - interval->low) / median;
}

double median(std::vector<double> sample) {
  if (sample.empty()) throw std::invalid_argument("the median of no sample");
  std::sort(sample.begin(), sample.end());
  const std::size_t n = sample.size();
  return n % 2 == 1 ? sample[n / 2] : 0.5 * (sample[n / 2 - 1] + sample[n / 2]);
}

Estimate estimate(std::vector<double> sample) {
  Estimate result;
  result.count = sample.size();
  result.median = median(sample);
  if (sample.size() < interval_samples) return result;
  std::sort(sample.begin(), sample.end());
  const std::size_t k = order_of_lower_bound(sample.size());
  result.interval = Interval{sample[k - 1], sample[sample.size() - k]};
  return result;
}

double rank_sum_p_value(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) throw std::invalid_argument("the rank-sum test of an empty sample");
  std::vector<std::pair<double, bool>> all;
  for (const double value : a) all.emplace_back(value, true);
  for (const double value : b) all.emplace_back(value, false);
  std::sort(all.begin(), all.end());
  const double n = double(all.size()), na = double(a.size()), nb = double(b.size());
  double rank_sum = 0, ties = 0;
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first;
    while (last + 1 < all.size() && all[last + 1].first == all[first].first) ++last;
    const double tied = double(last - first + 1);
    ties += tied * tied * tied - tied;
    for (std::size_t place = first; place <= last; ++place)
      if (all[place].second) rank_sum += 0.5 * double(first + last) + 1;
    first = last + 1;
  }
  const double deviation = std::abs(rank_sum - na * (na + 1) / 2 - na * nb / 2) - 0.5;
  const double variance = na * nb / 12 * (n + 1 - ties / (n * (n - 1)));
  if (variance <= 0) return 1; // all samples are equal
  return std::erfc(std::max(deviation, 0.0) / std::sqrt(2 * variance));
}

std::vector<std::size_t> outliers(std::span<const double> sample) {
  std::vector<std::size_t> places;
  if (sample.size() < interval_samples) return places;
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  const double q1 = quantile(sorted, 0.25), q3 = quantile(sorted, 0.75), reach = 3 * (q3 - q1);
  for (std::size_t place = 0; place < sample.size(); ++place)
    if (sample[place] < q1 - reach || sample[place] > q3 + reach) places.push_back(place);
  return places;
}

} // namespace dss
