#pragma once
/// Raw records grouped into samples: what tables and comparisons are made of.
#include "experiments/runner/records.hpp"
#include "experiments/runner/statistics.hpp"

#include <map>
#include <string>
#include <vector>

namespace dss {

/// Columns of results/raw/<experiment>.csv, one row a repetition (and attempt).
const std::vector<std::string>& raw_columns();

/// Repetitions below this say little of a step: starting threads and the clock's own time are in them [s].
constexpr double short_sample_s = 0.1;

/// All that was measured of one cell. Of a repetition that was retried, the last attempt counts; all attempts stay in
/// the raw file.
struct CellSample {
  std::string key;
  std::map<long, Record> repetitions; ///< those with a time, by number
  Record last;                        ///< the last record of the cell, whatever became of it
  long contaminated = 0;              ///< of the repetitions that count
  long too_short = 0;                 ///< of them, those below short_sample_s

  bool is_empty() const { return repetitions.empty(); }
  /// Wall times [s] in order of repetitions.
  std::vector<double> wall_s() const;
  /// Seconds a step, by repetition.
  std::map<long, double> step_s() const;
  /// "passed" if every repetition passed its check, else the first other verdict.
  std::string check() const;
  /// "ok" if every repetition and the last record are, else the first other status.
  std::string status() const;
  /// More workers than the machine had cores: its times are shown, and count for nothing.
  bool is_oversubscribed() const;
  /// Largest error of any repetition, NaN without a check.
  double check_error() const;
};

/// Groups records by their cell, in order of first appearance.
std::vector<CellSample> samples_of(const std::vector<Record>& records);

/// Ratios a / b of two cells' seconds a step over the repetitions that both have.
std::vector<double> paired_ratios(const CellSample& a, const CellSample& b);

/// A median with its interval's ends in COLUMN_low and COLUMN_high, which are empty without an interval.
void put_interval(Record& row, const std::string& column, const Estimate& estimate);

} // namespace dss
