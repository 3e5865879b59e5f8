#pragma once
/// Groups raw records into samples, the input of tables and comparisons.
#include "experiments/base/records.hpp"
#include "experiments/base/statistics.hpp"

#include <map>
#include <string>
#include <vector>

namespace dss {

/// Repetitions shorter than this [s] are unreliable: they include starting threads and reading the
/// clock.
constexpr double short_sample_s = 0.1;

/// A sample: all repetitions of one cell. If a repetition was retried, the last attempt counts. The
/// raw file keeps all attempts.
struct CellSample {
  std::string key;
  std::map<long, Record> repetitions; ///< those that have a time, by number
  Record last;                        ///< the last record of the cell, with or without a time
  long contaminated = 0;              ///< number of contaminated repetitions
  long too_short = 0;                 ///< number of repetitions shorter than short_sample_s

  bool is_empty() const { return repetitions.empty(); }
  /// Wall times [s] in order of repetitions.
  std::vector<double> wall_s() const;
  /// Time per step [s] of each repetition.
  std::map<long, double> step_s() const;
  /// "passed" if every repetition passed its check, else the first other verdict.
  std::string check() const;
  /// "ok" if every repetition and the last record are, else the first other status.
  std::string status() const;
  /// Why status() is not "ok".
  std::string reason() const;
  /// True with more workers than cores: times are shown but not compared.
  bool is_oversubscribed() const;
  /// Largest error of any repetition; NaN without a check.
  double check_error() const;
};

/// Groups records by cell, in order of first appearance.
std::vector<CellSample> samples_of(const std::vector<Record>& records);

/// Ratios a / b of the times per step, for the repetitions that both cells have.
std::vector<double> paired_ratios(const CellSample& a, const CellSample& b);

/// Numbers in a column, of the repetitions that have one.
std::vector<double> numbers_of(const CellSample& sample, const std::string& column);

/// Puts a median in COLUMN and the ends of its interval in COLUMN_low and COLUMN_high. Without an
/// interval those two stay empty.
void put_interval(Record& row, const std::string& column, const Estimate& estimate);

} // namespace dss
