#pragma once
/// The command line of dssbench: its commands and options, and what is wrong with one.
#include "experiments/cli/commands.hpp"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dss {

/// All commands and their options.
class CommandLine {
public:
  CommandLine();
  CommandLine(const CommandLine&) = delete; // options refer to members
  CommandLine& operator=(const CommandLine&) = delete;

  /// Reads a command line. Nothing runs yet.
  /// @param words  those after the program's name
  /// @throws InputError if a command or option is unknown, or a value is invalid: the message names
  ///     the nearest one; CLI::Success if help or the version was asked for
  void parse(const std::vector<std::string>& words);
  const std::string& command() const { return command_; } ///< that the user gave; empty if none
  const std::vector<std::string>& variant_path() const { return variant_path_; }
  /// Runs the command that was given. @return the exit code
  int run() const { return chosen_(); }
  const CLI::App& app() const { return app_; }

private:
  CLI::App app_;
  std::string command_;
  std::vector<std::string> variant_path_;
  Chosen chosen_;
};

} // namespace dss
