#pragma once
/// Compares the speed-ups of two tables of the same study: how well a result repeats itself.
#include "experiments/base/records.hpp"
#include "experiments/base/statistics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A speed-up, or a factor of a chain, with its interval.
struct Speedup {
  double median = 0;
  Interval interval;
};

/// The same speed-up in two tables; empty in a table that lacks it.
struct SpeedupPair {
  std::string row, column;
  std::optional<Speedup> before, after;
  bool is_in_both() const { return before && after; }
  /// True if each median lies in the interval of the other.
  bool is_within() const;
  bool do_intervals_overlap() const;
};

/// Columns of speed-ups and factors, which have columns with the ends of their intervals.
std::vector<std::string> speedup_columns(const Table& table);

/// All speed-ups of two tables. A row is known by its study, scale, scene, overrides, label, model,
/// precision and method. A base has no speed-up over itself.
/// @throws InputError if two rows of a table are the same and both have a speed-up
std::vector<SpeedupPair> pair_speedups(const Table& before, const Table& after);

} // namespace dss
