#pragma once
/// Compares the speed-ups of two tables of the same study, or of two results of many studies: how
/// well a result repeats itself.
#include "experiments/base/records.hpp"
#include "experiments/base/statistics.hpp"

#include <filesystem>
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

/// How well speed-ups repeat themselves. One that only OLD has did not.
struct Repetition {
  long count = 0, within = 0, overlapping = 0; ///< of OLD's speed-ups
  std::vector<double> differences;             ///< |NEW/OLD - 1| of those that both have
  void add(const SpeedupPair& pair);
  void add(const Repetition& other);
  /// True if 19 of 20 intervals overlap.
  bool does_repeat() const;
  /// "18 of 20 medians lie in each other's intervals, ..."; both must have a speed-up
  std::string sentence() const;
};

/// Columns of speed-ups and factors, which have columns with the ends of their intervals.
std::vector<std::string> speedup_columns(const Table& table);

/// All speed-ups of two tables. A row is known by its study, scale, scene, overrides, label, model,
/// precision and method. A base has no speed-up over itself.
/// @throws InputError if two rows of a table are the same and both have a speed-up
std::vector<SpeedupPair> pair_speedups(const Table& before, const Table& after);

/// The speed-ups of one table of two results.
struct TablePairs {
  std::string name;
  bool is_in_before = true, is_in_after = true;
  std::vector<SpeedupPair> pairs; ///< empty if it is only in `after`
};

/// The same of all tables NAME.csv below tables/ that hold speed-ups, in the order of their names.
/// @throws InputError as above, or if `before` has no such table
std::vector<TablePairs> pair_results(const std::filesystem::path& before,
                                     const std::filesystem::path& after);

} // namespace dss
