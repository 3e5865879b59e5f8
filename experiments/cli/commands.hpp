#pragma once
/// The commands of dssbench. Each function adds one command to the command line. The command that
/// the user gave sets `chosen`, which returns the exit code.
#include "experiments/base/exit_code.hpp"

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace dss {

using Chosen = std::function<int()>;

/// Names of all commands in the order of the help, and a command by its name (null if unknown).
std::vector<std::string> command_names(const CLI::App& app);
const CLI::App* find_command(const CLI::App& app, const std::string& name);

/// Each function adds one command.
void add_list_command(CLI::App& app, Chosen& chosen);
void add_run_command(CLI::App& app, Chosen& chosen);
void add_advise_command(CLI::App& app, Chosen& chosen);
void add_verify_command(CLI::App& app, Chosen& chosen);
void add_experiment_command(CLI::App& app, Chosen& chosen);
void add_sweep_command(CLI::App& app, Chosen& chosen);
void add_stability_command(CLI::App& app, Chosen& chosen);
void add_compare_command(CLI::App& app, Chosen& chosen);
void add_simulate_command(CLI::App& app, Chosen& chosen);
void add_decompose_command(CLI::App& app, Chosen& chosen);
void add_explain_command(CLI::App& app, Chosen& chosen);
void add_bench_command(CLI::App& app, Chosen& chosen);
void add_completion_command(CLI::App& app, Chosen& chosen);
void add_help_command(CLI::App& app, Chosen& chosen);

} // namespace dss
