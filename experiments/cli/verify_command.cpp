#include "experiments/base/progress.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/plan/job.hpp"
#include "experiments/run/verify/verify.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "solver/scene/scene_text.hpp"
#include "variants/isa/denormals.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>

namespace dss {
namespace {

struct VerifyArguments {
  std::vector<std::string> scenes, variants;
  std::string json, device;
  std::vector<int> ranks;
  bool is_quiet = false;
};

constexpr long most_steps_on_ranks = 40; ///< few steps, because there are many combinations

const char* text_of(VerifyRow::Verdict verdict) {
  return verdict == VerifyRow::Verdict::passed   ? "passed"
         : verdict == VerifyRow::Verdict::failed ? "FAILED"
                                                 : "skipped";
}

/// Variants to verify. Adds a row for each variant that cannot run here.
std::vector<const Plugin*> chosen_plugins(const std::vector<std::string>& asked,
                                          std::vector<VerifyRow>& rows) {
  std::vector<std::string> known;
  for (const VariantStatus& status : asked_variants()) known.push_back(status.name);
  for (const std::string& name : asked)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(
          fmt::format("variant \"{}\" does not exist; {}", name, nearest_name(name, known)));
  std::vector<const Plugin*> plugins;
  for (const VariantStatus& status : asked_variants()) {
    if (!asked.empty() && std::find(asked.begin(), asked.end(), status.name) == asked.end())
      continue;
    // skipping a requested variant would prove nothing
    if (!asked.empty() && status.is_outside() && !status.is_usable())
      throw InputError(fmt::format("variant {} cannot run here: {}", status.name, status.unusable));
    if (status.is_usable())
      plugins.push_back(&load_variant(status.name));
    else
      rows.push_back({"all",
                      "",
                      "",
                      status.name,
                      "all",
                      {},
                      {},
                      VerifyRow::Verdict::skipped,
                      status.unusable});
  }
  return plugins;
}

/// Requires that the device is present and that one of the variants computes on devices.
void require_device(const std::string& device, const std::vector<const Plugin*>& plugins) {
  if (device.empty()) return;
  const auto is_on_devices = [](const Plugin* plugin) { return plugin->devices != nullptr; };
  const auto found = std::find_if(plugins.begin(), plugins.end(), is_on_devices);
  if (found == plugins.end())
    throw InputError(fmt::format(
        "--device {}: none of the variants here computes on devices; give --variant opencl, and "
        "see `dssbench list variants`",
        device));
  choose_device((*found)->devices(), device);
}

nlohmann::ordered_json rows_json(const std::vector<VerifyRow>& rows) {
  nlohmann::ordered_json json;
  json["context"] = measurement_context();
  json["rows"] = nlohmann::ordered_json::array();
  for (const VerifyRow& row : rows)
    json["rows"].push_back(
        {{"scene", row.scene},
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

VerifyRow row_of(const nlohmann::json& json) {
  const std::string verdict = json["verdict"];
  VerifyRow row{
      json["scene"], json["model"], json["precision"], json["variant"], json["check"], {}, {}, {},
      json["reason"]};
  for (const auto one :
       {VerifyRow::Verdict::passed, VerifyRow::Verdict::failed, VerifyRow::Verdict::skipped})
    if (verdict == text_of(one)) row.verdict = one;
  return row;
}

/// Hint for the case that f64 passes and single precision fails by a small factor: the cause is
/// more often rounding in the scene than a wrong variant.
std::string rounding_hint(const std::vector<VerifyRow>& rows) {
  constexpr double little = 30;
  double most = 0;
  bool has_f64 = false;
  for (const VerifyRow& row : rows) {
    const bool is_f64 = row.precision == name(Precision::f64);
    has_f64 |= is_f64 && row.verdict == VerifyRow::Verdict::passed;
    if (row.verdict != VerifyRow::Verdict::failed) continue;
    if (is_f64 || !row.error || !row.tolerance) return {};
    const double ratio = *row.error / *row.tolerance;
    if (!(ratio <= little)) return {}; // also for NaN
    most = std::max(most, ratio);
  }
  if (most == 0 || !has_f64) return {};
  return fmt::format(
      "f64 passes everywhere, and single precision misses its tolerance by at most {:.2g}: if that "
      "is this "
      "scene's rounding, which grows with its steps, give it a \"tolerance\" of f32 (\"run\")\n",
      most);
}

void print_rows(const std::vector<VerifyRow>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const VerifyRow& row : rows)
    cells.push_back({row.scene, row.model, row.precision, row.variant, row.check,
                     row.error ? fmt::format("{:.2e}", *row.error) : "",
                     row.tolerance ? fmt::format("{:.0e}", *row.tolerance) : "",
                     text_of(row.verdict), row.reason});
  fmt::print("{}", text_table({"scene", "model", "precision", "variant", "check", "error",
                               "tolerance", "verdict", "reason"},
                              cells));
}

/// Removes passed rows, and merges rows that were skipped for the same reason.
std::vector<VerifyRow> brief(const std::vector<VerifyRow>& rows) {
  std::vector<VerifyRow> shown;
  std::map<std::string, std::size_t> times;
  for (const VerifyRow& row : rows) {
    const bool is_skipped = row.verdict == VerifyRow::Verdict::skipped;
    if (row.verdict != VerifyRow::Verdict::passed && (!is_skipped || ++times[row.reason] == 1))
      shown.push_back(row);
  }
  for (VerifyRow& row : shown)
    if (const std::size_t count = times[row.reason];
        row.verdict == VerifyRow::Verdict::skipped && count > 1)
      row.reason += fmt::format(" (and {} more)", count - 1);
  return shown;
}

/// Calls visit(overrides as text, scene, steps) for every small version of these scenes.
template <class Visit>
void each_case(const std::vector<std::string>& names, Visit&& visit) {
  std::vector<Scene> defaults; // read all scenes first, so that a wrong name is reported at once
  for (const std::string& name : names) defaults.push_back(load_scene(name));
  flush_denormals();
  Progress progress;
  for (std::size_t place = 0; place < names.size(); ++place) {
    if (job_rank().is_root()) progress.show(double(place), double(names.size()), names[place]);
    for (const VerifyCase& small : defaults[place].verify) {
      const std::vector<Override> overrides = verify_overrides(small);
      std::string set; // a scene may have several small versions
      for (const Override& item : overrides) set += fmt::format(" {}={}", item.key, item.value);
      visit(set, load_scene(names[place], overrides), small.steps);
    }
  }
}

void add_rows(std::vector<VerifyRow> of_scene, const std::string& set,
              std::vector<VerifyRow>& rows) {
  for (VerifyRow& row : of_scene) {
    row.scene += set;
    rows.push_back(std::move(row));
  }
}

/// Verifies the variant on the ranks of this job.
std::vector<VerifyRow> rows_of_ranks(const std::vector<std::string>& names,
                                     const std::string& variant, const std::string& device) {
  const Plugin &distributed = load_variant("mpi"), &part = load_variant(variant);
  require_device(device, {&part});
  std::vector<VerifyRow> rows;
  each_case(names, [&](const std::string& set, const Scene& scene, long steps) {
    add_rows(verify_ranks(scene, std::min(steps, most_steps_on_ranks), distributed, part,
                          job_rank().ranks, device),
             set, rows);
  });
  return rows;
}

/// Starts a job for each number of ranks and collects their rows.
std::vector<VerifyRow> rows_of_jobs(const VerifyArguments& arguments,
                                    const std::vector<std::string>& names) {
  std::vector<VerifyRow> rows;
  for (const int ranks : arguments.ranks) {
    if (const std::string why = why_no_ranks(); !why.empty()) {
      rows.push_back({"all",
                      "",
                      "",
                      "mpi",
                      fmt::format("{} ranks", ranks),
                      {},
                      {},
                      VerifyRow::Verdict::skipped,
                      why});
      continue;
    }
    std::vector<std::string> line = {"verify", "--json", "-", "--ranks", fmt::format("{}", ranks)};
    if (!arguments.variants.empty())
      line.insert(line.end(), {"--variant", arguments.variants.front()});
    if (!arguments.device.empty()) line.insert(line.end(), {"--device", arguments.device});
    line.insert(line.end(), names.begin(), names.end());
    const JobResult job = run_job(ranks, 1, line);
    const auto json = nlohmann::json::parse(job.output, nullptr, false);
    if (!json.is_object())
      rows.push_back({"all",
                      "",
                      "",
                      "mpi",
                      fmt::format("{} ranks", ranks),
                      {},
                      {},
                      VerifyRow::Verdict::failed,
                      job.failure.empty() ? "its result is no JSON" : job.failure});
    else
      for (const auto& row : json["rows"]) rows.push_back(row_of(row));
  }
  return rows;
}

std::vector<VerifyRow> rows_of_variants(const VerifyArguments& arguments,
                                        const std::vector<std::string>& names) {
  std::vector<VerifyRow> rows;
  const std::vector<const Plugin*> plugins = chosen_plugins(arguments.variants, rows);
  if (arguments.device != no_device) require_device(arguments.device, plugins);
  each_case(names, [&](const std::string& set, const Scene& scene, long steps) {
    add_rows(verify_scene(scene, steps, plugins, arguments.device), set, rows);
  });
  return rows;
}

int verify(VerifyArguments arguments) {
  if (arguments.ranks.empty() && job_rank().is_started) arguments.ranks = {job_rank().ranks};
  CommandFiles inputs;
  for (const std::string& scene : arguments.scenes) inputs.read_scene(scene);
  require_sound_output(std::move(inputs), arguments.json);
  if (job_rank().is_started && arguments.ranks != std::vector<int>{job_rank().ranks})
    throw InputError(fmt::format("--ranks: this job has {}; give that, or none", job_rank().ranks));
  if (!arguments.ranks.empty() && arguments.variants.size() > 1)
    throw InputError("--ranks: give at most one --variant, which computes the parts");
  std::vector<std::string> names = arguments.scenes;
  if (names.empty())
    for (const SceneListing& listing : list_scenes()) names.push_back(listing.name);
  const std::vector<VerifyRow> rows =
      arguments.ranks.empty() ? rows_of_variants(arguments, names)
      : arguments.ranks.size() > 1 || arguments.ranks.front() != job_rank().ranks
          ? rows_of_jobs(arguments, names)
          : rows_of_ranks(names, arguments.variants.empty() ? "auto" : arguments.variants.front(),
                          arguments.device);
  const auto count = [&](VerifyRow::Verdict verdict) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const VerifyRow& row) { return row.verdict == verdict; });
  };
  const auto failed = count(VerifyRow::Verdict::failed), passed = count(VerifyRow::Verdict::passed);
  if (!arguments.json.empty() && job_rank().is_root()) write_json(arguments.json, rows_json(rows));
  if (arguments.json != "-") {
    print_rows(arguments.is_quiet ? brief(rows) : rows);
    fmt::print("{} checks passed, {} failed, {} skipped\n", passed, failed,
               count(VerifyRow::Verdict::skipped));
    fmt::print("{}", rounding_hint(rows));
  }
  if (failed == 0 && passed == 0)
    throw InputError("verify: no variant could be verified here; see dssbench list variants");
  return failed == 0 ? exit_success : exit_check_failed;
}

} // namespace

void add_verify_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("verify", "Compare every variant with the oracle and with the other "
                                   "variants, on small versions of the scenes");
  const auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("SCENE", arguments->scenes, "Names or paths (default: all shipped scenes)");
  command->add_option("--variant", arguments->variants, "V,...: verify only these variants")
      ->type_name("VARIANT")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--ranks", arguments->ranks,
                   "R,...: instead, verify on these numbers of ranks that every decomposition and "
                   "halo strategy gives the same bits as one process")
      ->delimiter(',')
      ->check(CLI::Range(1, 4096))
      ->allow_extra_args(false);
  command
      ->add_option("--device", arguments->device,
                   "For variants on devices: a device, as for `dssbench run` (default: the first); "
                   "none: leave these variants out")
      ->type_name("DEVICE");
  command->add_option("--json", arguments->json, "File for the table, or - for standard output");
  command->add_flag("--quiet", arguments->is_quiet,
                    "Print only failed rows, and one row for each reason to skip");
  command->footer(
      "Example: dssbench verify plate_paper tumbling_box --variant avx2,avx512\n"
      "         dssbench verify plate_paper --ranks 1,2,3\nExit code 1 if anything failed.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return verify(*arguments); }; });
}

} // namespace dss
