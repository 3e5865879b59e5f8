#include "experiments/run/state/refinement.hpp"

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

double length(const Vec3& v) { return std::hypot(v[0], v[1], v[2]); }
Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double rms_distance(const History& a, const History& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double distance = length(difference(a[k], b[k]));
    sum += distance * distance;
  }
  return std::sqrt(sum / double(a.size()));
}

} // namespace

Extrapolation extrapolate(const std::array<History, 3>& grids, double ratio, bool has_limit) {
  const auto& [coarse, middle, fine] = grids;
  const double first = rms_distance(middle, coarse), second = rms_distance(fine, middle);
  Extrapolation result;
  result.order = std::log(first / second) / std::log(ratio);
  result.converges = has_limit && result.order > 0;
  const double weight = result.converges ? 1 / (std::pow(ratio, result.order) - 1) : 0;
  double largest = 0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const Vec3 step = difference(fine[k], middle[k]);
    const Vec3 limit = {fine[k][0] + weight * step[0], fine[k][1] + weight * step[1],
                        fine[k][2] + weight * step[2]};
    result.value = length(limit);
    largest = std::max(largest, result.value);
    result.error_final = length(difference(coarse[k], limit));
    result.error = std::max(result.error, result.error_final);
  }
  result.error /= largest;
  result.error_final /= largest;
  return result;
}

} // namespace dss
