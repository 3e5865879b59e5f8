#include "experiments/cli/commands.hpp"
#include "experiments/studies/run_study.hpp"

#include <memory>

namespace dss {

void add_experiment_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("experiment", "Measure a study; repetitions are interleaved, each in its "
                                       "own process, and each result is checked");
  const auto name = std::make_shared<std::string>();
  const auto options = std::make_shared<StudyOptions>();
  command->add_option("EXPERIMENT", *name, "A name from `dssbench list experiments`, or a path")
      ->required();
  command
      ->add_option("--scale", options->scale,
                   "A scale of the study: smoke (seconds), quick, host (minutes), full")
      ->capture_default_str()
      ->type_name("SCALE");
  command->add_option("--out", options->directory, "Directory of raw/, tables/ and oracle/")
      ->capture_default_str();
  command->add_flag("--resume", options->resumes,
                    "Keep existing records and measure only what is missing");
  command
      ->add_option("--rounds", options->rounds,
                   "Stop after so many rounds of repetitions, and run no other part of the study; "
                   "--resume goes on. If other studies run in between, a busy neighbour disturbs "
                   "only some of the rounds")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command->add_flag("--dry-run", options->is_dry, "Print the plan and measure nothing");
  command->footer("Example: dssbench experiment table1_host --scale smoke --out "
                  "smoke-results\nExit code 1 if a cell failed or was wrong.");
  command->callback([name, options, &chosen] {
    chosen = [name, options] { return run_study_file(*name, *options); };
  });
}

} // namespace dss
