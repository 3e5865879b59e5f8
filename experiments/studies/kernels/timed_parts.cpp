#include "experiments/studies/kernels/timed_parts.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/measure/samples.hpp"
#include "experiments/run/plan/context.hpp"

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

double seconds(Timed& timed) {
  const auto start = Clock::now();
  for (long pass = 0; pass < timed.passes; ++pass) timed.pass();
  return seconds_since(start);
}

/// The first pass touches memory, and another program may disturb a single one.
double undisturbed_seconds(Timed& timed) {
  const double first_s = seconds(timed);
  return std::min(first_s, seconds(timed));
}

std::vector<double> figures(const TimedParts& parts, const Figure& figure) {
  std::vector<double> values;
  for (std::size_t round = 0; round < parts.begin()->second.ns.size(); ++round)
    values.push_back(figure([&](const std::string& name) {
      const auto found = parts.find(name);
      return found == parts.end() ? std::nan("") : found->second.ns[round];
    }));
  return values;
}

} // namespace

void time_rounds(TimedParts& parts, int rounds, double sample_s) {
  for (auto& [name, timed] : parts)
    for (double time = undisturbed_seconds(timed); time < sample_s;
         time = undisturbed_seconds(timed))
      timed.passes = std::max(timed.passes + 1,
                              long(double(timed.passes) * std::min(8.0, 1.1 * sample_s / time)));
  for (int round = 0; round < rounds; ++round)
    for (auto& [name, timed] : parts) {
      timed.time_utc.push_back(measurement_time());
      timed.ns.push_back(1e9 * seconds(timed) / (timed.elements * double(timed.passes)));
    }
}

double over_rounds(const TimedParts& parts, const Figure& figure) {
  const std::vector<double> values = figures(parts, figure);
  return std::isnan(values.front()) ? values.front() : median(values);
}

void put_figure(Record& row, const std::string& column, const TimedParts& parts,
                const Figure& figure) {
  const std::vector<double> values = figures(parts, figure);
  if (!std::isnan(values.front())) put_interval(row, column, estimate(values));
}

} // namespace dss
