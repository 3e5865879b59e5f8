#include "experiments/measure/samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {

std::vector<double> CellSample::wall_s() const {
  std::vector<double> times;
  for (const auto& [number, record] : repetitions) times.push_back(number_in(record, "wall_s"));
  return times;
}

std::map<long, double> CellSample::step_s() const {
  std::map<long, double> times;
  for (const auto& [number, record] : repetitions)
    times[number] = number_in(record, "wall_s") / number_in(record, "steps");
  return times;
}

std::string CellSample::check() const {
  for (const auto& [number, record] : repetitions)
    if (text_in(record, "check") != "passed") return text_in(record, "check");
  return repetitions.empty() ? "none" : "passed";
}

static const Record& first_not_ok(const CellSample& sample) {
  for (const auto& [number, record] : sample.repetitions)
    if (text_in(record, "status") != "ok") return record;
  return sample.last;
}

std::string CellSample::status() const { return text_in(first_not_ok(*this), "status"); }
std::string CellSample::reason() const { return text_in(first_not_ok(*this), "reason"); }

bool CellSample::is_oversubscribed() const {
  const double ranks = number_in(last, "ranks"); // absent in records of kernels
  return (std::isnan(ranks) ? 1 : ranks) * number_in(last, "threads") > number_in(last, "cores");
}

double CellSample::check_error() const {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [number, record] : repetitions)
    for (const char* column : {"check_error", "check_tail_error"})
      if (const double error = number_in(record, column); !std::isnan(error))
        most = std::isnan(most) ? error : std::max(most, error);
  return most;
}

std::vector<double> numbers_of(const CellSample& sample, const std::string& column) {
  std::vector<double> numbers;
  for (const auto& [repetition, record] : sample.repetitions)
    if (const double number = number_in(record, column); !std::isnan(number))
      numbers.push_back(number);
  return numbers;
}

std::vector<CellSample> samples_of(const std::vector<Record>& records) {
  std::vector<CellSample> samples;
  std::map<std::string, std::size_t> places;
  for (const Record& record : records) {
    const auto [place, is_new] = places.try_emplace(text_in(record, "cell"), samples.size());
    if (is_new) samples.push_back({place->first, {}, {}, 0, 0});
    CellSample& sample = samples[place->second];
    sample.last = record;
    if (!text_in(record, "wall_s").empty())
      sample.repetitions[long(number_in(record, "repetition"))] = record;
  }
  for (CellSample& sample : samples)
    for (const auto& [number, record] : sample.repetitions) {
      sample.contaminated += text_in(record, "contaminated") == "true";
      const double repeated_s = number_in(record, "sample_s"); // absent in older records
      sample.too_short +=
          (std::isnan(repeated_s) ? number_in(record, "wall_s") : repeated_s) < short_sample_s;
    }
  return samples;
}

std::vector<double> paired_ratios(const CellSample& a, const CellSample& b) {
  const auto of_a = a.step_s(), of_b = b.step_s();
  std::vector<double> ratios;
  for (const auto& [number, time] : of_a)
    if (const auto other = of_b.find(number); other != of_b.end() && other->second > 0)
      ratios.push_back(time / other->second);
  return ratios;
}

void put_interval(Record& row, const std::string& column, const Estimate& estimate) {
  row[column] = number_text(estimate.median);
  if (!estimate.interval) return;
  row[column + "_low"] = number_text(estimate.interval->low);
  row[column + "_high"] = number_text(estimate.interval->high);
}

} // namespace dss
