#include "experiments/measure/compare.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/measure/samples.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

std::vector<double> step_times(const CellSample& sample) {
  std::vector<double> times;
  for (const auto& [number, time] : sample.step_s()) times.push_back(time);
  return times;
}

Comparison compared(const CellSample& before, const CellSample& after, double resolution) {
  const std::vector<double> a = step_times(before), b = step_times(after);
  const Estimate of_a = estimate(a), of_b = estimate(b);
  Comparison result{before.key,
                    "too few repetitions",
                    fmt::format("{} and {}; 6 are needed", a.size(), b.size()),
                    of_a.median,
                    of_b.median,
                    of_b.median / of_a.median,
                    {},
                    {},
                    false};
  if (!of_a.interval || !of_b.interval) return result;
  result.low = of_b.interval->low / of_a.interval->high;
  result.high = of_b.interval->high / of_a.interval->low;
  bool differs = *result.low > 1 || *result.high < 1;
  result.how = "95 % intervals";
  if (std::min(a.size(), b.size()) >= rank_sum_samples) {
    const double p = rank_sum_p_value(a, b);
    differs = p < 0.05;
    result.how = fmt::format("Mann-Whitney, p = {:.2g}", p);
  }
  if (!differs || std::abs(*result.ratio - 1) <= resolution)
    result.verdict = fmt::format("same within {:.2g} %",
                                 100 * std::max({resolution, *result.high - 1, 1 - *result.low}));
  else
    result.verdict = *result.ratio < 1 ? "faster" : "slower";
  return result;
}

/// Reason why the times of a sample cannot be compared, or empty.
std::string invalidity(const CellSample& sample) {
  if (sample.status() != "ok") return sample.status();
  if (sample.is_oversubscribed()) return "oversubscribed";
  return sample.check() == "passed" ? std::string() : "check " + sample.check();
}

bool is_wrong(const CellSample& sample) {
  return (sample.status() != "ok" && sample.status() != "skipped") || sample.check() == "failed";
}

} // namespace

std::vector<Comparison> compare_records(const std::vector<Record>& old_records,
                                        const std::vector<Record>& new_records, double resolution) {
  const std::vector<CellSample> before = samples_of(old_records), after = samples_of(new_records);
  const auto find = [](const std::vector<CellSample>& samples,
                       const std::string& key) -> const CellSample* {
    const auto found = std::find_if(samples.begin(), samples.end(),
                                    [&](const CellSample& sample) { return sample.key == key; });
    return found == samples.end() ? nullptr : &*found;
  };
  const auto bare = [](const std::string& key, const std::string& verdict, const std::string& how) {
    return Comparison{key, verdict, how, {}, {}, {}, {}, {}, false};
  };
  std::vector<Comparison> results;
  for (const CellSample& old_sample : before) {
    const CellSample* new_sample = find(after, old_sample.key);
    if (new_sample == nullptr) {
      results.push_back(bare(old_sample.key, "only in OLD", ""));
      results.back().is_new_wrong =
          true; // a cell that is no longer measured counts as a failed one
      continue;
    }
    const CellSample& invalid = invalidity(*new_sample).empty() ? old_sample : *new_sample;
    if (const std::string why = invalidity(invalid); !why.empty())
      results.push_back(
          bare(old_sample.key, "no claim: " + why,
               (&invalid == new_sample ? "NEW: " : "OLD: ") + text_in(invalid.last, "reason")));
    else
      results.push_back(compared(old_sample, *new_sample, resolution));
    results.back().is_new_wrong = is_wrong(*new_sample);
  }
  for (const CellSample& new_sample : after)
    if (find(before, new_sample.key) == nullptr) {
      results.push_back(bare(new_sample.key, "only in NEW", text_in(new_sample.last, "reason")));
      results.back().is_new_wrong = is_wrong(new_sample);
    }
  return results;
}

} // namespace dss
