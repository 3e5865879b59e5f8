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

// A command NAME is the file NAME_command.cpp, which defines add_NAME_command, and one word here,
// in the order of the help.
#define DSS_EACH_COMMAND(command)                                                                  \
  command(list) command(run) command(explain) command(advise) command(verify) command(experiment)  \
      command(sweep) command(stability) command(compare) command(diff) command(voxelize)           \
          command(decompose) command(simulate) command(bench) command(completion) command(help)

#define DSS_DECLARE(name) void add_##name##_command(CLI::App& app, Chosen& chosen);
DSS_EACH_COMMAND(DSS_DECLARE)
#undef DSS_DECLARE

} // namespace dss
