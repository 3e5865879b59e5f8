#include "experiments/cli/compare_speedups.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace dss {
namespace {

/// A result repeats itself if at least so many of its speed-ups do.
constexpr double repeating_share = 0.95;

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

/// Tables below `result`/tables by their names.
std::map<std::string, Table> tables_with_speedups(const std::filesystem::path& result) {
  std::map<std::string, Table> tables;
  std::error_code no_folder;
  for (const auto& entry : std::filesystem::directory_iterator(result / "tables", no_folder)) {
    if (entry.path().extension() != ".csv") continue;
    Table table = read_csv(entry.path().string());
    if (!speedup_columns(table).empty()) tables[entry.path().stem().string()] = std::move(table);
  }
  return tables;
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

void Repetition::add(const SpeedupPair& pair) {
  count += pair.before.has_value();
  within += pair.is_within();
  overlapping += pair.do_intervals_overlap();
  if (pair.is_in_both())
    differences.push_back(std::abs(pair.after->median / pair.before->median - 1));
}

void Repetition::add(const Repetition& other) {
  count += other.count;
  within += other.within;
  overlapping += other.overlapping;
  differences.insert(differences.end(), other.differences.begin(), other.differences.end());
}

bool Repetition::does_repeat() const {
  return double(overlapping) >= repeating_share * double(count);
}

std::string Repetition::sentence() const {
  return fmt::format("{} of {} medians lie in each other's intervals, {} of {} intervals overlap; "
                     "medians differ by {:.1f} % (median), at most by {:.1f} %",
                     within, count, overlapping, count, 100 * median(differences),
                     100 * std::ranges::max(differences));
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

std::vector<TablePairs> pair_results(const std::filesystem::path& before,
                                     const std::filesystem::path& after) {
  const std::map<std::string, Table> old_tables = tables_with_speedups(before),
                                     new_tables = tables_with_speedups(after);
  if (old_tables.empty())
    throw InputError(fmt::format("{}: has no tables/NAME.csv with speed-ups; give two directories "
                                 "that studies wrote (--out), or two files",
                                 before.string()));
  std::vector<TablePairs> results;
  for (const auto& [name, table] : old_tables) {
    const auto other = new_tables.find(name);
    const bool is_in_after = other != new_tables.end();
    try {
      results.push_back(
          {name, true, is_in_after, pair_speedups(table, is_in_after ? other->second : Table{})});
    } catch (const InputError& error) {
      throw InputError(fmt::format("tables/{}.csv: {}", name, error.what()));
    }
  }
  for (const auto& [name, table] : new_tables)
    if (!old_tables.contains(name)) results.push_back({name, false, true, {}});
  return results;
}

} // namespace dss
