#include "experiments/cli/compare_speedups.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace dss {
namespace {

using Keys = std::array<std::string, 2>; ///< of a row, and of a column
using Speedups = std::map<Keys, Speedup>;

bool is_in(double value, const Interval& interval) {
  return interval.low <= value && value <= interval.high;
}

std::string key_of(const Record& row) {
  std::string key;
  for (const char* column :
       {"label", "set", "model", "precision", "integrator", "scene", "experiment", "scale"})
    if (const std::string text = text_in(row, column); !text.empty())
      key += (key.empty() ? "" : ", ") + text;
  return key;
}

Speedups speedups_of(const Table& table) {
  Speedups found;
  for (const std::string& column : speedup_columns(table))
    for (const Record& row : table.rows) {
      const Speedup speedup{number_in(row, column),
                            {number_in(row, column + "_low"), number_in(row, column + "_high")}};
      if (std::isnan(speedup.median) || !(speedup.interval.low < speedup.interval.high)) continue;
      if (const std::string key = key_of(row); !found.emplace(Keys{key, column}, speedup).second)
        throw InputError(fmt::format("two rows are \"{}\" and have {}", key, column));
    }
  return found;
}

std::optional<Speedup> in(const Speedups& speedups, const Keys& keys) {
  const auto found = speedups.find(keys);
  return found == speedups.end() ? std::nullopt : std::optional(found->second);
}

} // namespace

bool SpeedupPair::is_within() const {
  return is_in_both() && is_in(before->median, after->interval) &&
         is_in(after->median, before->interval);
}

bool SpeedupPair::do_intervals_overlap() const {
  return is_in_both() && before->interval.low <= after->interval.high &&
         after->interval.low <= before->interval.high;
}

std::vector<std::string> speedup_columns(const Table& table) {
  std::vector<std::string> columns;
  for (const std::string& column : table.columns)
    for (const char* start : {"speedup_vs_", "extrapolated_speedup_vs_", "factor_"})
      if (column.starts_with(start) && table.has_column(column + "_low")) columns.push_back(column);
  return columns;
}

std::vector<SpeedupPair> pair_speedups(const Table& before, const Table& after) {
  const Speedups of_before = speedups_of(before), of_after = speedups_of(after);
  std::vector<SpeedupPair> pairs;
  for (const auto& [keys, speedup] : of_before)
    pairs.push_back({keys[0], keys[1], speedup, in(of_after, keys)});
  for (const auto& [keys, speedup] : of_after)
    if (!of_before.contains(keys)) pairs.push_back({keys[0], keys[1], {}, speedup});
  return pairs;
}

} // namespace dss
