#include "experiments/microbenchmarks/micro_study.hpp"
#include "experiments/runner/advise/advise_study.hpp"
#include "experiments/runner/atlas/continuum_study.hpp"
#include "experiments/runner/atlas/failure_study.hpp"
#include "experiments/runner/balance_study.hpp"
#include "experiments/runner/chain/chain_study.hpp"
#include "experiments/runner/child.hpp"
#include "experiments/runner/circumstances.hpp"
#include "experiments/runner/commands.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/experiment.hpp"
#include "experiments/runner/model/ladder_study.hpp"
#include "experiments/runner/precision/error_budget.hpp"
#include "experiments/runner/progress.hpp"
#include "experiments/runner/simulation_study.hpp"
#include "experiments/runner/stability_study.hpp"
#include "experiments/runner/statics/statics_study.hpp"
#include "experiments/runner/text_table.hpp"

#include "solver/io/atomic_file.hpp"
#include "solver/numerics/denormals.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct ExperimentArguments {
  std::string file, scale = "host", out = "results";
  bool resumes = false, is_dry = false;
};

void print_plan(const Study& study, const std::string& out) {
  std::vector<std::vector<std::string>> rows;
  for (const Cell& cell : study.cells)
    rows.push_back({cell.scene, cell.set_text(), cell.label(), cell.model, cell.precision, cell.integrator,
                    fmt::format("{}", cell.steps),
                    cell.skipped.empty() ? "" : fmt::format("{}: {}", cell.skipped_status(), cell.skipped)});
  fmt::print("{} ({}, scale {})\n{}", study.title, study.name, study.scale.name,
             text_table({"scene", "set", "cell", "model", "precision", "integrator", "steps", "note"}, rows));
  const ExperimentPaths paths = experiment_paths(out, study.name);
  fmt::print("{} cells, {} to {} repetitions each, at most about {}.\nTable: {}\nRecords: {}\n", study.cells.size(),
             study.scale.min_repetitions, study.scale.max_repetitions, duration_text(study.scale.budget_s), paths.table,
             paths.raw);
}

/// Where the table of a study goes, made sure that it can be written.
std::string table_path(const std::string& name, const std::string& out) {
  const std::string path = experiment_paths(out, name).table;
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
  require_writable(path);
  return path;
}

/// What made a table without records of its own: raw/NAME.json.
void write_context(const std::string& name, const ExperimentArguments& arguments) {
  const ExperimentPaths paths = experiment_paths(arguments.out, name);
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(paths.context).parent_path(), error);
  Study study;
  study.name = name, study.scale.name = arguments.scale;
  write_circumstances(paths.context, measurement_context(), study);
}

void write_table(const std::string& name, const ExperimentArguments& arguments, const Table& table) {
  write_csv(experiment_paths(arguments.out, name).table, table);
  write_context(name, arguments);
}

/// Simulates what the study says, beside what it has measured.
int simulate(const std::string& name, const std::vector<SimulationBlock>& blocks, const std::string& out) {
  const ExperimentPaths paths = experiment_paths(out, name);
  const std::string path = table_path(name + "_simulated", out);
  const Table measured = std::filesystem::exists(paths.table) ? read_csv(paths.table) : Table{};
  const Table table = simulate_study(name, blocks, measured);
  write_csv(path, table);
  fmt::print("\n{}\nTable: {}\n", simulation_text(table), path);
  const bool has_failed =
      std::ranges::any_of(table.rows, [](const Record& row) { return text_in(row, "status") == "failed"; });
  return has_failed ? exit_check_failed : exit_success;
}

int model(const BalanceStudy& study, const ExperimentArguments& arguments) {
  const Table table = balance_table(study);
  if (arguments.is_dry) {
    fmt::print("{}: {} rows of a model\n", study.name, table.rows.size());
    return exit_success;
  }
  const std::string path = table_path(study.name, arguments.out);
  write_table(study.name, arguments, table);
  fmt::print("{}\nTable: {}\n", balance_text(study, table), path);
  return exit_success;
}

int find_limits(const StabilityStudy& study, const ExperimentArguments& arguments) {
  if (arguments.is_dry) {
    fmt::print("{}: step limits of every explicit method on {} problems\n", study.name, study.cases.size());
    return exit_success;
  }
  const std::string path = table_path(study.name, arguments.out);
  flush_denormals();
  const Table limits = stability_table(study), energy = stability_energy_table(study);
  write_table(study.name, arguments, limits);
  write_csv(experiment_paths(arguments.out, study.name + "_energy").table, energy);
  write_csv(experiment_paths(arguments.out, study.name + "_map").table, stability_map_table(study));
  fmt::print("{}\nTable: {}\n", stability_text(study, limits, energy), path);
  return has_failed_rows(limits) || has_failed_rows(energy) ? exit_check_failed : exit_success;
}

/// Checks against theory: a row that fails is a failed check.
template <class Study, class MakeTable, class MakeText>
int check(const Study& study, const ExperimentArguments& arguments, std::size_t size, MakeTable&& make_table,
          MakeText&& make_text) {
  if (arguments.is_dry) {
    fmt::print("{}: {} cases against theory\n", study.name, size);
    return exit_success;
  }
  const std::string path = table_path(study.name, arguments.out);
  const Table table = make_table(study);
  write_table(study.name, arguments, table);
  fmt::print("{}\nTable: {}\n", make_text(study, table), path);
  return has_failed_rows(table) ? exit_check_failed : exit_success;
}

int account(const ErrorBudgetStudy& study, const ExperimentArguments& arguments) {
  if (arguments.is_dry) {
    for (const BudgetScene& scene : study.scenes)
      fmt::print("{}: {}, {} at dt = {:g} s to {:g} s\n", study.name, scene.label, scene.integrator, scene.dt,
                 scene.times.end);
    return exit_success;
  }
  const std::string path = table_path(study.name, arguments.out);
  Progress progress;
  const Table table = error_budget_table(study, [&](const std::string& line) { progress.note(line); });
  write_table(study.name, arguments, table);
  fmt::print("{}\nTable: {}\n", error_budget_text(study, table), path);
  return has_failed_rows(table) ? exit_check_failed : exit_success;
}

int climb(const LadderStudy& study, const ExperimentArguments& arguments) {
  if (arguments.is_dry) {
    for (const LadderScene& scene : study.scenes)
      fmt::print("{}: {} {}, auto ends with {}\n", study.name, scene.scene, set_text(scene.set), name(scene.ends_with));
    return exit_success;
  }
  const std::string path = table_path(study.name, arguments.out);
  flush_denormals();
  Progress progress;
  const Table table = ladder_table(study, [&](const std::string& line) { progress.note(line); });
  write_table(study.name, arguments, table);
  fmt::print("{}\nTable: {}\n", ladder_text(study, table), path);
  return has_failed_rows(table) ? exit_check_failed : exit_success;
}

int judge_advice(const AdviseStudy& study, const ExperimentArguments& arguments) {
  if (arguments.is_dry) {
    fmt::print("{}: advice on {} scenes at {} tolerances\n", study.name, study.cases.size(), study.tolerances.size());
    return exit_success;
  }
  const std::string path = table_path(study.name, arguments.out);
  Progress progress;
  const Table table = advise_table(study, experiment_paths(arguments.out, study.name).oracle_directory,
                                   [&](const std::string& line) { progress.note(line); });
  write_table(study.name, arguments, table);
  fmt::print("{}\nTable: {}\n", advise_study_text(study, table), path);
  return has_failed_rows(table) ? exit_check_failed : exit_success;
}

int time_kernels(const MicroStudy& study, const ExperimentArguments& arguments) {
  if (arguments.is_dry) {
    fmt::print("{}: {} sets of microbenchmarks, {} repetitions, {} steps to attribute\n", study.name, study.sets.size(),
               study.rules.repetitions, study.attribution.size());
    return exit_success;
  }
  return run_micro_study(study, arguments.out, arguments.resumes) ? exit_success : exit_check_failed;
}

int time_chain(const ChainStudy& study, const ExperimentArguments& arguments) {
  if (arguments.is_dry) {
    for (const ChainLink& link : study.links)
      fmt::print("{}: {}: {} t{} {} {} {}\n", study.name, link.label, link.variant, link.threads, name(link.model),
                 name(link.precision), link.integrator);
    return exit_success;
  }
  return run_chain(study, arguments.out, arguments.resumes) ? exit_success : exit_check_failed;
}

int experiment(const ExperimentArguments& arguments) {
  if (const auto advice = load_advise(arguments.file, arguments.scale)) return judge_advice(*advice, arguments);
  if (const auto failures = load_failures(arguments.file, arguments.scale))
    return check(*failures, arguments, failures->cases.size(), failures_table, failures_text);
  if (const auto continuum = load_continuum(arguments.file, arguments.scale))
    return check(*continuum, arguments, continuum->checks.size(), continuum_table, continuum_text);
  if (const auto ladder = load_ladder(arguments.file, arguments.scale)) return climb(*ladder, arguments);
  if (const auto statics = load_statics(arguments.file, arguments.scale))
    return check(*statics, arguments, statics->cases.size(), statics_table, statics_text);
  if (const auto budget = load_error_budget(arguments.file, arguments.scale)) return account(*budget, arguments);
  if (const auto balance = load_balance(arguments.file, arguments.scale)) return model(*balance, arguments);
  if (const auto micro = load_micro_study(arguments.file, arguments.scale)) return time_kernels(*micro, arguments);
  if (const auto chain = load_chain(arguments.file, arguments.scale)) return time_chain(*chain, arguments);
  if (const auto limits = load_stability(arguments.file, arguments.scale)) return find_limits(*limits, arguments);
  const std::vector<SimulationBlock> blocks = load_simulation(arguments.file, arguments.scale);
  const std::string simulated_only = name_if_simulated_only(arguments.file);
  if (!simulated_only.empty() && arguments.is_dry) {
    fmt::print("{}: {} blocks to simulate\n", simulated_only, blocks.size());
    return exit_success;
  }
  if (!simulated_only.empty()) {
    const int code = simulate(simulated_only, blocks, arguments.out);
    write_context(simulated_only, arguments);
    return code;
  }
  const Study study = load_study(arguments.file, arguments.scale, usable_cores());
  if (arguments.is_dry) {
    print_plan(study, arguments.out);
    return exit_success;
  }
  const bool is_fine = run_experiment(study, arguments.out, arguments.resumes, this_program);
  const int simulated = blocks.empty() ? exit_success : simulate(study.name, blocks, arguments.out);
  return is_fine ? simulated : exit_check_failed;
}

} // namespace

void add_experiment_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "experiment", "Measure a study: interleaved, each repetition in its own process, each result checked");
  const auto arguments = std::make_shared<ExperimentArguments>();
  command->add_option("EXPERIMENT", arguments->file, "A name from `dssbench list experiments`, or a path")->required();
  command->add_option("--scale", arguments->scale, "A scale of the study: smoke (seconds), host (minutes), paper")
      ->capture_default_str()
      ->type_name("SCALE");
  command->add_option("--out", arguments->out, "Directory of raw/, tables/ and oracle/")->capture_default_str();
  command->add_flag("--resume", arguments->resumes, "Keep the records present and measure what is missing");
  command->add_flag("--dry-run", arguments->is_dry, "Print the cells and stop");
  command->footer("Example: dssbench experiment table1_host --scale smoke --out smoke-results\nExit code 1 if a cell "
                  "failed or was wrong.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return experiment(*arguments); }; });
}

} // namespace dss
