#include "experiments/base/text_table.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/compare_speedups.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/compare.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct CompareArguments {
  std::string before, after;
};

/// @throws InputError if a column of raw records is missing
void require_raw_records(const std::string& path, const Table& table) {
  for (const char* column : {"cell", "repetition", "wall_s", "steps", "check", "status"})
    if (!table.has_column(column))
      throw InputError(fmt::format(
          "{}: has no column \"{}\"; give raw records, results/raw/NAME.csv, or tables of "
          "speed-ups, results/tables/NAME.csv",
          path, column));
}

std::string shown(const std::optional<double>& value, double scale, const char* form) {
  return value ? fmt::format(fmt::runtime(form), *value * scale) : std::string();
}

/// A result repeats itself if at least so many of its speed-ups do.
constexpr double repeating_share = 0.95;

std::string shown(const std::optional<Speedup>& speedup) {
  return speedup ? fmt::format("{:.4g} [{:.4g}, {:.4g}]", speedup->median, speedup->interval.low,
                               speedup->interval.high)
                 : std::string();
}

const char* verdict(const SpeedupPair& pair) {
  if (!pair.is_in_both()) return pair.before ? "only in OLD" : "only in NEW";
  if (pair.is_within()) return "within each other's intervals";
  return pair.do_intervals_overlap() ? "intervals overlap" : "apart";
}

/// A speed-up that only OLD has did not repeat itself.
int compare_tables(const CompareArguments& arguments, const Table& before, const Table& after) {
  const std::vector<SpeedupPair> pairs = pair_speedups(before, after);
  std::vector<std::vector<std::string>> rows;
  std::vector<double> differences;
  long count = 0, within = 0, overlapping = 0;
  for (const SpeedupPair& pair : pairs) {
    count += pair.before.has_value();
    within += pair.is_within();
    overlapping += pair.do_intervals_overlap();
    std::string ratio;
    if (pair.is_in_both()) {
      differences.push_back(std::abs(pair.after->median / pair.before->median - 1));
      ratio = fmt::format("{:.3f}", pair.after->median / pair.before->median);
    }
    rows.push_back(
        {pair.row, pair.column, shown(pair.before), shown(pair.after), ratio, verdict(pair)});
  }
  if (differences.empty())
    throw InputError(fmt::format("{} and {} have no speed-up with an interval in common; compare "
                                 "two tables of one study at one scale",
                                 arguments.before, arguments.after));
  const bool repeats = double(overlapping) >= repeating_share * double(count);
  fmt::print("{}", text_table({"row", "column", "old", "new", "new/old", "verdict"}, rows));
  fmt::print("{} of {} medians lie in each other's intervals, {} of {} intervals overlap; medians "
             "differ by {:.1f} % (median), at most by {:.1f} %: the result {}.\n",
             within, count, overlapping, count, 100 * median(differences),
             100 * std::ranges::max(differences),
             repeats ? "repeats itself"
                     : "does not repeat itself (19 of 20 intervals should overlap)");
  return repeats ? exit_success : exit_check_failed;
}

int compare(const CompareArguments& arguments) {
  const Table old_table = read_csv(arguments.before), new_table = read_csv(arguments.after);
  if (!speedup_columns(old_table).empty() && !speedup_columns(new_table).empty())
    return compare_tables(arguments, old_table, new_table);
  require_raw_records(arguments.before, old_table);
  require_raw_records(arguments.after, new_table);
  const std::vector<Record>&before = old_table.rows, &after = new_table.rows;
  const std::optional<double> old_resolution = resolution_of(before),
                              new_resolution = resolution_of(after);
  const double resolution =
      std::max({default_resolution, old_resolution.value_or(0), new_resolution.value_or(0)});
  const std::vector<Comparison> comparisons = compare_records(before, after, resolution);
  if (std::all_of(comparisons.begin(), comparisons.end(),
                  [](const Comparison& c) { return c.verdict.starts_with("only in"); }))
    throw InputError(
        fmt::format("{} and {} have no cell in common; compare two runs of one study at one scale",
                    arguments.before, arguments.after));
  std::vector<std::vector<std::string>> rows;
  for (const Comparison& c : comparisons)
    rows.push_back({c.cell, shown(c.old_step_s, 1e6, "{:.4g}"), shown(c.new_step_s, 1e6, "{:.4g}"),
                    shown(c.ratio, 1, "{:.3f}"),
                    c.low ? fmt::format("[{:.3f}, {:.3f}]", *c.low, *c.high) : "", c.verdict,
                    c.how});
  fmt::print(
      "{}",
      text_table({"cell", "old [us]", "new [us]", "new/old", "interval", "verdict", "by"}, rows));
  fmt::print(
      "Times are of a step, or of a kernel's pass over its operands. Resolution {:.1f} % ({}).\n",
      100 * resolution, old_resolution || new_resolution ? "A/A pairs" : "default: no A/A pair");
  const bool is_worse =
      std::any_of(comparisons.begin(), comparisons.end(),
                  [](const Comparison& c) { return c.verdict == "slower" || c.is_new_wrong; });
  return is_worse ? exit_check_failed : exit_success;
}

} // namespace

void add_compare_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("compare", "Compare two results of a study, cell by cell");
  const auto arguments = std::make_shared<CompareArguments>();
  command
      ->add_option("OLD", arguments->before,
                   "Raw records, results/raw/NAME.csv, or a table of speed-ups or of a chain")
      ->required();
  command->add_option("NEW", arguments->after, "The same of another result")->required();
  command->footer("Example: dssbench compare before/raw/table1_host.csv "
                  "results/raw/table1_host.csv\nExit code 1 if a cell is slower by more than the "
                  "resolution, or if it is wrong, failed or missing in NEW, or if fewer than 19 of "
                  "20 intervals of "
                  "speed-ups overlap.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return compare(*arguments); }; });
}

} // namespace dss
