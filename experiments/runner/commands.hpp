#pragma once
/// The commands of dssbench. Each adds itself to the command line; the one that was given sets `chosen`, which returns
/// the exit code.
#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace dss {

/// Exit codes of the program (DESIGN.md section 7).
enum ExitCode { exit_success = 0, exit_check_failed = 1, exit_bad_input = 2, exit_unstable = 3 };
inline constexpr std::array exit_code_meanings = {"success", "a check failed", "bad input",
                                                  "a run is or would be unstable"};

using Chosen = std::function<int()>;

/// The commands of the program, in the order of its help; one by its name, or null.
std::vector<std::string> command_names(const CLI::App& app);
const CLI::App* find_command(const CLI::App& app, const std::string& name);

void add_list_command(CLI::App& app, Chosen& chosen);
void add_run_command(CLI::App& app, Chosen& chosen);
void add_advise_command(CLI::App& app, Chosen& chosen);
void add_verify_command(CLI::App& app, Chosen& chosen);
void add_experiment_command(CLI::App& app, Chosen& chosen);
void add_stability_command(CLI::App& app, Chosen& chosen);
void add_compare_command(CLI::App& app, Chosen& chosen);
void add_simulate_command(CLI::App& app, Chosen& chosen);
void add_decompose_command(CLI::App& app, Chosen& chosen);
void add_explain_command(CLI::App& app, Chosen& chosen);
void add_bench_command(CLI::App& app, Chosen& chosen);
void add_completion_command(CLI::App& app, Chosen& chosen);
void add_help_command(CLI::App& app, Chosen& chosen);

} // namespace dss
