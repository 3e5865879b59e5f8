#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/decomposition/decomposition_file.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/scene/scene_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <numeric>

namespace dss {
namespace {

constexpr int most_depth = 255; // the number of a layer is stored in a byte
constexpr std::size_t most_rows_shown = 16;
constexpr std::size_t bytes_of_element = field_count * sizeof(double);

struct DecomposeArguments {
  std::string scene, method = "strips", output, from, json;
  int parts = 0, depth = 1;
  std::vector<double> speeds, costs;
  std::vector<std::string> set;
};

/// Sizes of the parts of a decomposition, and what they exchange.
struct DecompositionReport {
  std::string scene;
  Decomposition decomposition;
  int depth = 0;
  std::vector<PartSize> sizes;
  std::vector<double> speeds; ///< of each part
  std::size_t cut = 0;        ///< links between parts
};

std::size_t halo_elements(const PartSize& size) {
  return std::accumulate(size.layer_elements.begin(), size.layer_elements.end(), std::size_t(0));
}

std::size_t sent_elements(const PartSize& size) {
  std::size_t count = 0;
  for (const PartSize::Face& face : size.faces) count += face.send;
  return count;
}

std::size_t sum(const std::vector<PartSize>& sizes, std::size_t (*of)(const PartSize&)) {
  std::size_t total = 0;
  for (const PartSize& size : sizes) total += of(size);
  return total;
}

std::size_t own_elements(const PartSize& size) { return size.own_elements; }

/// Largest compute time of a part relative to the mean, if every part works at its speed without
/// waiting. 1 is perfect.
double imbalance(const DecompositionReport& report) {
  const double elements = double(sum(report.sizes, own_elements));
  const double speed = std::accumulate(report.speeds.begin(), report.speeds.end(), 0.0);
  double largest = 0;
  for (std::size_t p = 0; p < report.sizes.size(); ++p)
    largest = std::max(largest,
                       double(report.sizes[p].own_elements) / elements * speed / report.speeds[p]);
  return largest;
}

nlohmann::ordered_json as_json(const DecompositionReport& report) {
  const std::size_t elements = sum(report.sizes, own_elements);
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (std::size_t p = 0; p < report.sizes.size(); ++p) {
    const PartSize& size = report.sizes[p];
    parts.push_back({{"part", p},
                     {"own_elements", size.own_elements},
                     {"own_rows", size.own_rows},
                     {"cost_share", double(size.own_elements) / double(elements)},
                     {"neighbours", size.faces.size()},
                     {"halo_elements", halo_elements(size)},
                     {"sent_elements", sent_elements(size)},
                     {"sent_bytes_per_step", bytes_of_element * sent_elements(size)}});
  }
  return {{"scene", report.scene},
          {"method", report.decomposition.method},
          {"part_count", report.sizes.size()},
          {"depth", report.depth},
          {"elements", elements},
          {"imbalance", imbalance(report)},
          {"cut_links", report.cut},
          {"halo_elements", sum(report.sizes, halo_elements)},
          {"halo_bytes_per_step", bytes_of_element * sum(report.sizes, sent_elements)},
          {"parts", parts}};
}

void print(const DecompositionReport& report) {
  const std::size_t elements = sum(report.sizes, own_elements);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t p = 0; p < std::min(report.sizes.size(), most_rows_shown); ++p) {
    const PartSize& size = report.sizes[p];
    rows.push_back({fmt::format("{}", p), fmt::format("{}", size.own_elements),
                    fmt::format("{:.3f}", 100 * double(size.own_elements) / double(elements)),
                    fmt::format("{}", size.faces.size()), fmt::format("{}", halo_elements(size)),
                    fmt::format("{}", bytes_of_element * sent_elements(size))});
  }
  fmt::print("{}: {} elements in {} parts ({}), halo of {} layer{}\n", report.scene, elements,
             report.sizes.size(), report.decomposition.method, report.depth,
             report.depth == 1 ? "" : "s");
  fmt::print("{}",
             text_table({"part", "elements", "cost [%]", "neighbours", "halo", "sent [bytes/step]"},
                        rows));
  if (report.sizes.size() > most_rows_shown) fmt::print("...\n");
  fmt::print("imbalance {:.4f} (largest/mean); {} cut links; halo {} elements, {} bytes a step\n",
             imbalance(report), report.cut, sum(report.sizes, halo_elements),
             bytes_of_element * sum(report.sizes, sent_elements));
}

void require_sound(const DecomposeArguments& arguments) {
  if (arguments.from.empty() && arguments.parts < 1)
    throw InputError(
        fmt::format("--parts {}: is not a number of parts; take 1 or more", arguments.parts));
  if (arguments.depth < 0 || arguments.depth > most_depth)
    throw InputError(fmt::format("--depth {}: is not a number of layers; take 0 to {}",
                                 arguments.depth, most_depth));
  for (const double speed : arguments.speeds)
    if (!(speed > 0)) throw InputError(fmt::format("--speeds: {} is not positive", speed));
  for (const std::string& target : {arguments.output, arguments.json})
    if (!target.empty() && target != "-") require_writable(target);
}

void require_distinct_files(const DecomposeArguments& arguments) {
  CommandFiles files;
  files.read_scene(arguments.scene, parse_overrides(arguments.set));
  files.read("--from", arguments.from);
  files.write("--output", arguments.output);
  files.write("--json", arguments.json);
  files.require_distinct();
}

int decompose_scene(const DecomposeArguments& arguments) {
  require_sound(arguments);
  require_distinct_files(arguments);
  const Scene scene = load_scene(arguments.scene, parse_overrides(arguments.set));
  const Problem& problem = scene.problem;
  DecompositionReport report;
  report.scene = scene.name;
  report.depth = arguments.depth;
  report.decomposition = arguments.from.empty()
                             ? decompose(problem, arguments.method, arguments.parts,
                                         {arguments.speeds, arguments.costs})
                             : read_decomposition(arguments.from, problem);
  const int parts = report.decomposition.parts;
  report.speeds =
      arguments.speeds.empty() ? std::vector<double>(std::size_t(parts), 1) : arguments.speeds;
  if (report.speeds.size() != std::size_t(parts))
    throw InputError(fmt::format("--speeds: {} speeds for {} parts; give one for each",
                                 report.speeds.size(), parts));
  if (!arguments.output.empty())
    write_decomposition(arguments.output, problem, report.decomposition, report.depth);
  for (int index = 0; index < parts; ++index)
    report.sizes.push_back(part_size(problem, report.decomposition, index, report.depth));
  report.cut = cut_links(problem, report.decomposition);
  if (arguments.json != "-") print(report);
  if (!arguments.json.empty()) write_json(arguments.json, as_json(report));
  return exit_success;
}

} // namespace

void add_decompose_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("decompose", "Divide a scene into parts and report what they exchange");
  const auto arguments = std::make_shared<DecomposeArguments>();
  command->add_option("SCENE", arguments->scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  CLI::Option* parts = command->add_option("--parts", arguments->parts, "Number of parts");
  CLI::Option* method = command
                            ->add_option("--method", arguments->method,
                                         fmt::format("{} (default: strips)",
                                                     fmt::join(names_of("DECOMPOSITION"), ", ")))
                            ->type_name("DECOMPOSITION");
  CLI::Option* from = command->add_option("--from", arguments->from,
                                          "Read the parts from a decomposition file instead");
  from->excludes(parts)->excludes(method);
  command
      ->add_option("--costs", arguments->costs,
                   "Relative cost of an element of each body: 1,1.4 (default: equal)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--speeds", arguments->speeds,
                   "Relative speed of each part: 1,1,2 (default: equal)")
      ->delimiter(',');
  command->add_option("--depth", arguments->depth, "Number of halo layers (default: 1)");
  command
      ->add_option("--set", arguments->set,
                   "Override a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("-o,--output", arguments->output,
                      "Decomposition file (JSON; format: solver/decomposition/README.md)");
  command->add_option("--json", arguments->json,
                      "File for the report as JSON, or - for standard output");
  command->footer("Example: dssbench decompose plate_paper --set n=100 --parts 4 --method blocks "
                  "--output plate.json\n"
                  "Bytes per step: 13 fields of 8 bytes for each element sent.");
  command->callback(
      [arguments, &chosen] { chosen = [arguments] { return decompose_scene(*arguments); }; });
}

} // namespace dss
