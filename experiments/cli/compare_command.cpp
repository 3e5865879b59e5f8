#include "experiments/base/text_table.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/compare.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct CompareArguments {
  std::string before, after;
};

std::vector<Record> raw_records(const std::string& path) {
  const Table table = read_csv(path);
  for (const char* column : {"cell", "repetition", "wall_s", "steps", "check", "status"})
    if (std::find(table.columns.begin(), table.columns.end(), column) == table.columns.end())
      throw InputError(fmt::format(
          "{}: has no column \"{}\"; give raw records, results/raw/NAME.csv", path, column));
  return table.rows;
}

std::string shown(const std::optional<double>& value, double scale, const char* form) {
  return value ? fmt::format(fmt::runtime(form), *value * scale) : std::string();
}

int compare(const CompareArguments& arguments) {
  const std::vector<Record> before = raw_records(arguments.before),
                            after = raw_records(arguments.after);
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
  command->add_option("OLD", arguments->before, "Raw records, results/raw/NAME.csv")->required();
  command->add_option("NEW", arguments->after, "Raw records of the same study")->required();
  command->footer("Example: dssbench compare before/raw/table1_host.csv "
                  "results/raw/table1_host.csv\nExit code 1 if a cell is slower by more than the "
                  "resolution, or if it is wrong, failed or missing in NEW.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return compare(*arguments); }; });
}

} // namespace dss
