#include "experiments/runner/arguments.hpp"
#include "experiments/runner/commands.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/progress.hpp"
#include "experiments/runner/text_table.hpp"
#include "experiments/runner/verify.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/nearest_name.hpp"
#include "solver/numerics/denormals.hpp"
#include "variants/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct VerifyArguments {
  std::vector<std::string> scenes, variants;
  std::string json;
  bool is_quiet = false;
};

const char* text_of(VerifyRow::Verdict verdict) {
  return verdict == VerifyRow::Verdict::passed   ? "passed"
         : verdict == VerifyRow::Verdict::failed ? "FAILED"
                                                 : "skipped";
}

/// Variants to verify; those that cannot run here become rows that say so.
std::vector<const Plugin*> chosen_plugins(const std::vector<std::string>& asked, std::vector<VerifyRow>& rows) {
  std::vector<std::string> known;
  for (const VariantStatus& status : variants()) known.push_back(status.name);
  for (const std::string& name : asked)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("--variant {}: unknown variant; {}", name, nearest_name(name, known)));
  std::vector<const Plugin*> plugins;
  for (const VariantStatus& status : variants()) {
    if (!asked.empty() && std::find(asked.begin(), asked.end(), status.name) == asked.end()) continue;
    if (status.is_usable())
      plugins.push_back(&load_variant(status.name));
    else
      rows.push_back({"all", "", "", status.name, "all", {}, {}, VerifyRow::Verdict::skipped, status.unusable});
  }
  return plugins;
}

nlohmann::ordered_json rows_json(const std::vector<VerifyRow>& rows) {
  nlohmann::ordered_json json;
  json["context"] = measurement_context();
  json["rows"] = nlohmann::ordered_json::array();
  for (const VerifyRow& row : rows)
    json["rows"].push_back({{"scene", row.scene},
                            {"model", row.model},
                            {"precision", row.precision},
                            {"variant", row.variant},
                            {"check", row.check},
                            {"error", row.error ? nlohmann::ordered_json(*row.error) : nullptr},
                            {"tolerance", row.tolerance ? nlohmann::ordered_json(*row.tolerance) : nullptr},
                            {"verdict", text_of(row.verdict)},
                            {"reason", row.reason}});
  return json;
}

void print_rows(const std::vector<VerifyRow>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const VerifyRow& row : rows)
    cells.push_back({row.scene, row.model, row.precision, row.variant, row.check,
                     row.error ? fmt::format("{:.2e}", *row.error) : "",
                     row.tolerance ? fmt::format("{:.0e}", *row.tolerance) : "", text_of(row.verdict), row.reason});
  fmt::print("{}",
             text_table({"scene", "model", "precision", "variant", "check", "error", "tolerance", "verdict", "reason"},
                        cells));
}

int verify(const VerifyArguments& arguments) {
  if (!arguments.json.empty() && arguments.json != "-") require_writable(arguments.json);
  std::vector<VerifyRow> rows;
  const std::vector<const Plugin*> plugins = chosen_plugins(arguments.variants, rows);
  std::vector<std::string> names = arguments.scenes;
  if (names.empty())
    for (const SceneListing& listing : list_scenes()) names.push_back(listing.name);
  std::vector<Scene> defaults; // all are read before any is run: a wrong name costs no waiting
  for (const std::string& name : names) defaults.push_back(load_scene(name));
  flush_denormals();
  Progress progress;
  for (std::size_t place = 0; place < names.size(); ++place) {
    progress.show(double(place), double(names.size()), names[place]);
    for (const VerifyCase& small : defaults[place].verify) {
      const std::vector<Override> overrides = verify_overrides(small);
      std::string set; // a scene may have several small versions
      for (const Override& item : overrides) set += fmt::format(" {}={}", item.key, item.value);
      const Scene scene = load_scene(names[place], overrides);
      for (VerifyRow& row : verify_scene(scene, small.steps, plugins)) {
        row.scene += set;
        rows.push_back(std::move(row));
      }
    }
  }
  const auto count = [&](VerifyRow::Verdict verdict) {
    return std::count_if(rows.begin(), rows.end(), [&](const VerifyRow& row) { return row.verdict == verdict; });
  };
  const auto failed = count(VerifyRow::Verdict::failed), passed = count(VerifyRow::Verdict::passed);
  if (!arguments.json.empty()) write_json(arguments.json, rows_json(rows));
  if (arguments.json != "-") {
    std::vector<VerifyRow> shown = rows;
    if (arguments.is_quiet)
      std::erase_if(shown, [](const VerifyRow& row) { return row.verdict == VerifyRow::Verdict::passed; });
    print_rows(shown);
    fmt::print("{} checks passed, {} failed, {} skipped\n", passed, failed, count(VerifyRow::Verdict::skipped));
  }
  if (failed == 0 && passed == 0)
    throw InputError("verify: no variant could be verified here; see dssbench list variants");
  return failed == 0 ? exit_success : exit_check_failed;
}

} // namespace

void add_verify_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "verify", "Compare every variant with the oracle and with the others, on small versions of the scenes");
  const auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("SCENE", arguments->scenes, "Names or paths (default: all that are shipped)");
  command->add_option("--variant", arguments->variants, "V,...: only these variants")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--json", arguments->json, "File for the table, or - for standard output");
  command->add_flag("--quiet", arguments->is_quiet, "Print only what failed or was skipped");
  command->footer(
      "Example: dssbench verify plate_paper tumbling_box --variant avx2,avx512\nExit code 1 if anything failed.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return verify(*arguments); }; });
}

} // namespace dss
