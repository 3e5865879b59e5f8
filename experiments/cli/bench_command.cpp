#include "experiments/cli/commands.hpp"
#include "experiments/studies/kernels/micro_study.hpp"
#include "experiments/studies/run_study.hpp"
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

/// Replaces the study's selections by those of the command line.
void narrow(const BenchArguments& arguments, MicroStudy& study) {
  const bool names_kernels = !arguments.kernels.empty();
  if (names_kernels)
    study.sets = {MicroSet{arguments.kernels, {"*"}, {"*"}, {"*"}, {"L1"}, {1}, {100}}};
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
  const StudyFile file = open_study(arguments.study, arguments.scale);
  if (!ObjectNode(file.root).has("microbenchmarks"))
    throw InputError(fmt::format("--study {}: is not a study of microbenchmarks; give kernels",
                                 arguments.study));
  MicroStudy study = read_micro_study(file);
  narrow(arguments, study);
  return run_study(*kernel_study(study), {file.name, file.title, arguments.scale},
                   {arguments.scale, arguments.out, arguments.resumes, false});
}

} // namespace

void add_bench_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "bench", "Time single kernels (microbenchmarks); each is checked against long double");
  const auto arguments = std::make_shared<BenchArguments>();
  const auto list = [&](const char* option, auto& value, const char* what) {
    return command->add_option(option, value, what)->delimiter(',');
  };
  list("--kernel", arguments->kernels,
       "Names from `dssbench list kernels`; rk4_step: whole steps; rates: the rates kernel of a "
       "device (default: those of the study)");
  list("--model", arguments->models, "Models; * means all");
  list("--precision", arguments->precisions, "f64, f32");
  list("--variant", arguments->variants, "Variants; * means all that have kernels");
  list("--level", arguments->levels,
       "Memory level of the operands: L1, L2, L3, memory; * means all");
  list("--threads", arguments->threads, "Numbers of threads; each thread has its own operands")
      ->check(CLI::PositiveNumber);
  list("--n", arguments->sizes, "For rk4_step and rates: elements along an edge of the plate")
      ->check(CLI::Range(2, 100000));
  command
      ->add_option("--repetitions", arguments->repetitions,
                   "Repetitions of each kernel; `compare` needs 9")
      ->check(CLI::PositiveNumber);
  command->add_option("--min-time", arguments->sample_s, "Shortest time of a repetition [s]")
      ->check(CLI::PositiveNumber);
  command->add_option("--study", arguments->study, "The study whose kernels are timed")
      ->capture_default_str();
  command->add_option("--scale", arguments->scale, "A scale of the study")->capture_default_str();
  command->add_option("--out", arguments->out, "Directory of raw/ and tables/")
      ->capture_default_str();
  command->add_flag("--ceilings", arguments->has_ceilings,
                    "Also measure peak arithmetic and bandwidths (about a minute)");
  command->add_flag("--attribution", arguments->has_attribution,
                    "Also attribute the time of steps to row kernels");
  command->add_flag("--resume", arguments->resumes,
                    "Keep existing records and measure only what is missing");
  command->footer("Example: dssbench bench --kernel stage_row,rk4_step --model spatial --variant "
                  "avx512 --out before\n"
                  "Then, after a change, --out after and: dssbench compare before/raw/kernels.csv "
                  "after/raw/kernels.csv\n"
                  "Exit code 1 if results of a kernel were wrong.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return bench(*arguments); }; });
}

} // namespace dss
