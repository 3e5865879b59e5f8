#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/differences.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace dss {
namespace {

struct DiffArguments {
  std::string before, after, json;
  std::optional<double> tolerance;
};

nlohmann::ordered_json json_of(const Differences& differences) {
  nlohmann::ordered_json quantities = nlohmann::ordered_json::array();
  for (const Difference& one : differences.quantities) {
    const double relative = one.relative();
    quantities.push_back({{"quantity", one.quantity},
                          {"unit", one.unit},
                          {"largest_value", one.largest_value},
                          {"largest_difference", one.largest},
                          {"rms_difference", one.rms},
                          {"relative", std::isfinite(relative) ? nlohmann::ordered_json(relative)
                                                               : nlohmann::ordered_json()},
                          {"place", one.place}});
  }
  return {{"rows", differences.rows}, {"quantities", quantities}};
}

int diff(const DiffArguments& arguments) {
  CommandFiles files;
  files.read("A", arguments.before);
  files.read("B", arguments.after);
  require_sound_output(files, arguments.json);
  const Differences differences = differences_of(arguments.before, arguments.after);
  if (!arguments.json.empty()) write_json(arguments.json, json_of(differences));
  if (arguments.json != "-") {
    std::vector<std::vector<std::string>> rows;
    for (const Difference& one : differences.quantities)
      rows.push_back({fmt::format("{} [{}]", one.quantity, one.unit),
                      fmt::format("{:.4g}", one.largest_value), fmt::format("{:.3g}", one.largest),
                      fmt::format("{:.3g}", one.rms), fmt::format("{:.3g}", one.relative()),
                      one.largest > 0 ? one.place : ""});
    fmt::print("{} rows in both\n{}", differences.rows,
               text_table({"quantity", "largest in A", "largest difference", "rms", "relative",
                           "where it is largest"},
                          rows));
  }
  const bool is_within = std::ranges::all_of(differences.quantities, [&](const Difference& one) {
    return !arguments.tolerance || one.relative() <= *arguments.tolerance;
  });
  return is_within ? exit_success : exit_check_failed;
}

} // namespace

void add_diff_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "diff", "Compare two states or two histories: the difference of each quantity");
  const auto arguments = std::make_shared<DiffArguments>();
  command->add_option("A", arguments->before, "A file of `run --state` or `run --history`")
      ->required();
  command->add_option("B", arguments->after, "The same of another run of this body")->required();
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "Largest relative difference; a larger one of any quantity is exit code 1")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--json", arguments->json, "File for the result, or - for standard output");
  command->footer("Example: dssbench diff before.csv after.csv --tolerance 1e-6\n"
                  "A difference is relative to the largest value of A. A quantity that is zero but "
                  "for rounding has a large relative difference. Rows of a history are compared "
                  "where both have the same time.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return diff(*arguments); }; });
}

} // namespace dss
