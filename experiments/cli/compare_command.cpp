#include "experiments/base/text_table.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/compare_programs.hpp"
#include "experiments/cli/compare_speedups.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/compare.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

constexpr const char* of_commands = "Two commands"; ///< heading in the help

struct CompareArguments {
  std::string before, after;
  ProgramPair programs;
  CLI::App* command = nullptr;
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

using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> shown(const SpeedupPair& pair) {
  return {pair.row,
          pair.column,
          shown(pair.before),
          shown(pair.after),
          pair.is_in_both() ? fmt::format("{:.3f}", pair.after->median / pair.before->median) : "",
          verdict(pair)};
}

/// Ends the output of a comparison of speed-ups.
int conclude(const CompareArguments& arguments, const Repetition& repetition) {
  if (repetition.differences.empty())
    throw InputError(fmt::format("{} and {} have no speed-up with an interval in common; compare "
                                 "two tables, or two results, of the same studies at one scale",
                                 arguments.before, arguments.after));
  const bool repeats = repetition.does_repeat();
  fmt::print("{}: the result {}.\n", repetition.sentence(),
             repeats ? "repeats itself"
                     : "does not repeat itself (19 of 20 intervals should overlap)");
  return repeats ? exit_success : exit_check_failed;
}

int compare_tables(const CompareArguments& arguments, const Table& before, const Table& after) {
  Rows rows;
  Repetition repetition;
  for (const SpeedupPair& pair : pair_speedups(before, after)) {
    repetition.add(pair);
    rows.push_back(shown(pair));
  }
  if (!repetition.differences.empty())
    fmt::print("{}", text_table({"row", "column", "old", "new", "new/old", "verdict"}, rows));
  return conclude(arguments, repetition);
}

/// Shows how many speed-ups of each table repeat themselves, and which do not.
int compare_results(const CompareArguments& arguments) {
  Rows tables, apart;
  Repetition whole;
  for (const TablePairs& table : pair_results(arguments.before, arguments.after)) {
    Repetition repetition;
    for (const SpeedupPair& pair : table.pairs) {
      repetition.add(pair);
      if (!table.is_in_after || !pair.before || pair.do_intervals_overlap()) continue;
      apart.push_back(shown(pair));
      apart.back().insert(apart.back().begin(), table.name);
    }
    whole.add(repetition);
    const std::string of = fmt::format(" of {}", repetition.count);
    tables.push_back({table.name, std::to_string(repetition.within) + of,
                      std::to_string(repetition.overlapping) + of,
                      !table.is_in_after    ? "only in OLD"
                      : !table.is_in_before ? "only in NEW"
                                            : ""});
  }
  if (!whole.differences.empty()) {
    fmt::print("{}", text_table({"table", "medians within", "intervals overlap", ""}, tables));
    if (!apart.empty())
      fmt::print("{}",
                 text_table({"table", "row", "column", "old", "new", "new/old", "verdict"}, apart));
  }
  return conclude(arguments, whole);
}

int compare_commands(const CompareArguments& arguments) {
  ProgramPair pair = arguments.programs;
  split_commands(words_after_mark(), pair);
  if (pair.csv == "-" || pair.markdown == "-")
    throw InputError(fmt::format("{} -: takes a file; only --json writes to standard output",
                                 pair.csv == "-" ? "--csv" : "--markdown"));
  CommandFiles files;
  files.write("--json", pair.json);
  files.write("--csv", pair.csv);
  files.write("--markdown", pair.markdown);
  files.require_distinct();
  return compare_programs(pair);
}

int compare(const CompareArguments& arguments) {
  if (!words_after_mark().empty()) {
    if (!arguments.before.empty())
      throw InputError(fmt::format("{}: stands before \"--\", where only options stand if two "
                                   "commands are compared",
                                   arguments.before));
    return compare_commands(arguments);
  }
  if (arguments.after.empty())
    throw InputError("compare: takes two results, dssbench compare OLD NEW, or two commands, "
                     "dssbench compare -- A... -- B...");
  for (const CLI::Option* option : arguments.command->get_options())
    if (option->count() > 0 && option->get_group() == of_commands)
      throw InputError(
          fmt::format("{}: is for commands, dssbench compare -- A -- B", option->get_name()));
  const bool is_old_whole = std::filesystem::is_directory(arguments.before),
             is_new_whole = std::filesystem::is_directory(arguments.after);
  if (is_old_whole && is_new_whole) return compare_results(arguments);
  if (is_old_whole || is_new_whole)
    throw InputError(fmt::format("{}: is a directory, and {} is none; give two files, or two "
                                 "directories",
                                 is_old_whole ? arguments.before : arguments.after,
                                 is_old_whole ? arguments.after : arguments.before));
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
  CLI::App* command =
      app.add_subcommand("compare", "Compare two results: times of cells, or speed-ups");
  const auto arguments = std::make_shared<CompareArguments>();
  command->add_option(
      "OLD", arguments->before,
      "Raw records, results/raw/NAME.csv, a table of speed-ups or of a chain, or the "
      "directory of a whole result");
  command->add_option("NEW", arguments->after, "The same of another result");
  arguments->command = command;
  ProgramPair& pair = arguments->programs;
  command->add_option("--repetitions", pair.repetitions, "Runs of each command")
      ->check(CLI::Range(long(interval_samples), 100000L))
      ->group(of_commands);
  command->add_option("--warmup", pair.warmup, "Runs before these, which do not count")
      ->check(CLI::Range(0L, 1000L))
      ->group(of_commands);
  command->add_option("--time-limit", pair.time_limit_s, "Longest time of one run [s]")
      ->check(CLI::PositiveNumber)
      ->group(of_commands);
  command
      ->add_option("--patience", pair.patience_s,
                   "Longest time [s] for waiting until the machine is quiet, and for repeating "
                   "disturbed runs")
      ->check(CLI::NonNegativeNumber)
      ->group(of_commands);
  command->add_option("--json", pair.json, "Times and verdict; \"-\" is standard output")
      ->group(of_commands);
  command->add_option("--csv", pair.csv, "All runs, one in a row")->group(of_commands);
  command->add_option("--markdown", pair.markdown, "Times and verdict as a table")
      ->group(of_commands);
  command->footer(
      "Example: dssbench compare before/raw/table1_host.csv results/raw/table1_host.csv\n"
      "         dssbench compare results_of_monday results\n"
      "         dssbench compare --repetitions 30 -- ./before input -- OMP_NUM_THREADS=2 ./after\n"
      "Two commands run in turn, in random order, A twice a round: what A differs from itself is "
      "the resolution. Words NAME=VALUE before a command set variables. Of two directories, all "
      "tables with speed-ups are compared. Exit code 1 if a cell is slower "
      "by more than the resolution, or if it is wrong, failed or missing in NEW, or if fewer than "
      "19 of 20 intervals of speed-ups overlap.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return compare(*arguments); }; });
}

} // namespace dss
