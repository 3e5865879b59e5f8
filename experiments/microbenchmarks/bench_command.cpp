#include "experiments/microbenchmarks/micro_study.hpp"
#include "experiments/runner/commands.hpp"
#include "solver/error.hpp"

#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct BenchArguments {
  std::string study = "kernels", scale = "host", out = "bench";
  std::vector<std::string> kernels, models, precisions, variants, levels;
  std::vector<int> threads, sizes;
  int repetitions = 0;
  double sample_s = 0;
  bool has_ceilings = false, has_attribution = false, resumes = false;
};

/// What the command line says in place of the study's sets.
void narrow(const BenchArguments& arguments, MicroStudy& study) {
  const bool names_kernels = !arguments.kernels.empty();
  if (names_kernels) study.sets = {MicroSet{arguments.kernels, {"*"}, {"*"}, {"*"}, {"L1"}, {1}, {100}}};
  for (MicroSet& set : study.sets) {
    if (!arguments.models.empty()) set.models = arguments.models;
    if (!arguments.precisions.empty()) set.precisions = arguments.precisions;
    if (!arguments.variants.empty()) set.variants = arguments.variants;
    if (!arguments.levels.empty()) set.levels = arguments.levels;
    if (!arguments.threads.empty()) set.threads = arguments.threads;
    if (!arguments.sizes.empty()) set.sizes = arguments.sizes;
  }
  if (arguments.repetitions > 0) study.rules.repetitions = arguments.repetitions;
  if (arguments.sample_s > 0) study.rules.sample_s = arguments.sample_s;
  study.has_ceilings = arguments.has_ceilings;
  if (!arguments.has_attribution) study.attribution.clear();
}

int bench(const BenchArguments& arguments) {
  auto study = load_micro_study(arguments.study, arguments.scale);
  if (!study)
    throw InputError(fmt::format("--study {}: is not a study of microbenchmarks; give kernels", arguments.study));
  narrow(arguments, *study);
  return run_micro_study(*study, arguments.out, arguments.resumes) ? exit_success : exit_check_failed;
}

} // namespace

void add_bench_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("bench", "Time single kernels: microbenchmarks, each checked against long double");
  const auto arguments = std::make_shared<BenchArguments>();
  const auto list = [&](const char* option, auto& value, const char* what) {
    return command->add_option(option, value, what)->delimiter(',');
  };
  list("--kernel", arguments->kernels,
       "Kernels of `dssbench list kernels`; rk4_step: whole steps; rates: the kernel of a device; default: what the "
       "study says");
  list("--model", arguments->models, "Models, * for all");
  list("--precision", arguments->precisions, "f64, f32");
  list("--variant", arguments->variants, "Variants, * for all that have kernels");
  list("--level", arguments->levels, "Where the operands lie: L1, L2, L3, memory, * for all");
  list("--threads", arguments->threads, "Threads, each with operands of its own")->check(CLI::PositiveNumber);
  list("--n", arguments->sizes, "Of rk4_step and rates: elements a side of the plate")->check(CLI::Range(2, 100000));
  command->add_option("--repetitions", arguments->repetitions, "Of each; `compare` wants nine")
      ->check(CLI::PositiveNumber);
  command->add_option("--min-time", arguments->sample_s, "Least time of a repetition [s]")->check(CLI::PositiveNumber);
  command->add_option("--study", arguments->study, "Whose sets are timed")->capture_default_str();
  command->add_option("--scale", arguments->scale, "A scale of the study")->capture_default_str();
  command->add_option("--out", arguments->out, "Directory of raw/ and tables/")->capture_default_str();
  command->add_flag("--ceilings", arguments->has_ceilings, "Measure peak arithmetic and bandwidths too (a minute)");
  command->add_flag("--attribution", arguments->has_attribution, "Attribute the time of steps to row kernels too");
  command->add_flag("--resume", arguments->resumes, "Keep the records present and measure what is missing");
  command->footer(
      "Example: dssbench bench --kernel stage_row,rk4_step --model spatial --variant avx512 --out before\n"
      "Then, after a change, --out after and: dssbench compare before/raw/kernels.csv after/raw/kernels.csv\n"
      "Exit code 1 if results of a kernel were wrong.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return bench(*arguments); }; });
}

} // namespace dss
