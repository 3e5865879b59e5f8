#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/measure/cell_record.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/plan/device_listing.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "solver/numerics/method.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct ListArguments {
  std::string what;
  bool is_json = false, is_measured = false;
};

Listing variant_listing() {
  Listing list = Listing::array();
  const std::vector<VariantStatus> all = listed_variants();
  const bool has_outside = std::ranges::any_of(all, &VariantStatus::is_outside);
  for (const VariantStatus& status : all) {
    Listing item = {{"variant", status.name},
                    {"isa", status.isa},
                    {"fma", ""},
                    {"threads", ""},
                    {"status", "usable"}};
    if (status.is_usable() && !status.is_outside()) {
      const Plugin& plugin = load_variant(status.name);
      item["fma"] = plugin.has_fma ? "yes" : "no";
      item["threads"] = plugin.is_threaded ? "any" : "1";
    } else if (!status.is_usable()) {
      item["status"] = "unusable: " + status.unusable;
    }
    if (has_outside) item["from"] = status.is_outside() ? status.path : "this program";
    item["path"] = module_path(status);
    list.push_back(item);
  }
  return list;
}

Listing scene_listing() {
  Listing list = Listing::array();
  for (const SceneListing& scene : list_scenes()) {
    std::string parameters;
    for (const auto& [name, value] : scene.parameters)
      parameters += fmt::format("{}{}={:g}", parameters.empty() ? "" : " ", name, value);
    list.push_back({{"scene", scene.name},
                    {"parameters", parameters},
                    {"title", scene.title},
                    {"path", scene.path}});
  }
  return list;
}

Listing study_listing() {
  Listing list = Listing::array();
  for (const StudyListing& study : list_studies())
    list.push_back({{"experiment", study.name}, {"title", study.title}, {"path", study.path}});
  return list;
}

std::string variants_of(const Method& method) {
  if (method.is_implicit()) return "reference, sparse";
  return method.has_leaps() ? "all but reference, sparse" : "all but sparse";
}

Listing method_listing() {
  Listing list = Listing::array();
  std::vector<const Method*> methods = all_methods();
  for (const Method& method : exponential_methods()) methods.push_back(&method);
  for (const Method* method : methods)
    list.push_back(
        {{"method", std::string(method->name)},
         {"order", fmt::format("{}", method->order)},
         {"stages", method->is_exponential ? "as needed" : fmt::format("{}", method->stages)},
         {"imaginary limit", fmt::format("{:.4g}", method->imaginary_limit)},
         {"real limit", fmt::format("{:.4g}", method->real_limit)},
         {"symplectic", method->is_symplectic ? "yes" : "no"},
         {"energy", method->keeps_energy_bounded ? "bounded" : "drifts"},
         {"variants", variants_of(*method)},
         {"note", std::string(method->note)}});
  return list;
}

/// Kernels of the fastest variant that has any, with their declared flops (kernels/cases.hpp).
Listing kernel_listing() {
  Listing list = Listing::array();
  for (auto status = variants().rbegin(); status != variants().rend() && list.empty(); ++status) {
    if (!status->is_usable() || status->is_outside()) continue;
    const Plugin& plugin = load_variant(status->name);
    if (plugin.kernels == nullptr) continue;
    for (const CompiledKernel& kernel : plugin.kernels())
      list.push_back({{"kernel", kernel.name},
                      {"model", std::string(name(kernel.model))},
                      {"precision", std::string(name(kernel.precision))},
                      {"inputs", fmt::format("{}", kernel.inputs)},
                      {"outputs", fmt::format("{}", kernel.outputs)},
                      {"flops", fmt::format("{}", kernel.flops)},
                      {"variant", plugin.name},
                      {"lanes", fmt::format("{}", kernel.lanes)}});
  }
  return list;
}

/// The fields of records, raw/NAME.csv and tables of cells.
Listing column_listing() {
  Listing list = Listing::array();
  for (const ColumnMeaning& column : column_meanings())
    list.push_back({{"run --json", column.key},
                    {"raw", column.raw},
                    {"in tables", column.in_table},
                    {"unit", column.unit},
                    {"meaning", column.meaning}});
  return list;
}

Listing listing(const ListArguments& arguments) {
  const std::string& what = arguments.what;
  if (arguments.is_measured && what != "devices")
    throw InputError(fmt::format(
        "list {} --measure: only devices are measured; give list devices --measure", what));
  if (what == "variants") return variant_listing();
  if (what == "scenes") return scene_listing();
  if (what == "experiments") return study_listing();
  if (what == "methods") return method_listing();
  if (what == "kernels") return kernel_listing();
  if (what == "columns") return column_listing();
  if (what == "devices") return device_listing(arguments.is_measured);
  throw InputError(fmt::format("list {}: unknown; {}", what, nearest_name(what, names_of("WHAT"))));
}

int list(const ListArguments& arguments) {
  const Listing items = listing(arguments);
  if (arguments.is_json) {
    write_json("-", items);
    return exit_success;
  }
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  for (const auto& item : items) {
    head.clear();
    rows.emplace_back();
    for (const auto& [key, value] : item.items()) {
      if (key == "path") continue;
      head.push_back(key);
      rows.back().push_back(value.get<std::string>());
    }
  }
  fmt::print("{}", text_table(head, rows));
  return exit_success;
}

} // namespace

void add_list_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("list", "List what there is: variants, scenes, experiments, columns, ...");
  const auto arguments = std::make_shared<ListArguments>();
  command
      ->add_option(
          "WHAT", arguments->what,
          "variants, scenes, experiments, methods, kernels, devices or columns (of records)")
      ->required();
  command->add_flag("--json", arguments->is_json, "Print JSON, with paths");
  command->add_flag(
      "--measure", arguments->is_measured,
      "For devices: also measure memory bandwidth and peak arithmetic (some seconds each)");
  command->footer("Example: dssbench list variants");
  command->callback([arguments, &chosen] { chosen = [arguments] { return list(*arguments); }; });
}

} // namespace dss
