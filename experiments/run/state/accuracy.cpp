#include "experiments/run/state/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace dss {

AccuracyMeter::AccuracyMeter(const Problem& problem,
                             const std::vector<std::vector<double>>& expected)
    : expected_(expected), errors_(expected.size()) {
  KindValues most{};
  for (const std::vector<double>& state : expected) {
    const KindValues largest = largest_of_kinds(state);
    for (std::size_t kind = 0; kind < most.size(); ++kind)
      most[kind] = std::max(most[kind], largest[kind]);
  }
  scales_ = error_scales(problem, most);
}

void AccuracyMeter::add(std::size_t k, std::span<const double> state) {
  const KindValues differences = largest_differences(expected_[k], state);
  for (std::size_t kind = 0; kind < scales_.size(); ++kind)
    errors_[k][kind] = relative(differences[kind], scales_[kind]);
}

Accuracy AccuracyMeter::result() const {
  Accuracy accuracy;
  for (const auto& [u, q, v, w] : errors_) {
    accuracy.l2 += u * u / double(errors_.size());
    accuracy.max = std::max(accuracy.max, u);
    accuracy.rotation = std::max(accuracy.rotation, q);
    accuracy.velocity = std::max(accuracy.velocity, v);
    accuracy.spin = std::max(accuracy.spin, w);
  }
  accuracy.l2 = std::sqrt(accuracy.l2);
  accuracy.final = errors_.back()[0];
  return accuracy;
}

Accuracy accuracy_of(const Problem& problem, const std::vector<std::vector<double>>& expected,
                     const std::vector<std::vector<double>>& actual) {
  AccuracyMeter meter(problem, expected);
  for (std::size_t k = 0; k < expected.size(); ++k) meter.add(k, actual[k]);
  return meter.result();
}

} // namespace dss
