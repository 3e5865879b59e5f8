#pragma once
/// Times any programs in turn and compares them: `dssbench compare -- A -- B`.
#include <string>
#include <vector>

namespace dss {

/// What to run, and how often.
struct ProgramPair {
  /// Words of the command lines. The first ones may set variables, NAME=VALUE, as for `env`.
  std::vector<std::string> before, after;
  long repetitions = 20;     ///< of each program
  long warmup = 1;           ///< repetitions before these, which are not counted
  double time_limit_s = 600; ///< of one repetition
  double patience_s = 60;    ///< for waiting for a quiet machine and for repeating disturbed runs
  std::string json, csv, markdown; ///< files; empty: none, "-": standard output (JSON)
};

/// Splits "A... -- B..." at the mark. @throws InputError if there are not two commands
void split_commands(const std::vector<std::string>& words, ProgramPair& pair);

/// Runs both programs, and the first one twice in each round (an A/A pair), in random order. Prints
/// times and a verdict, and writes the files. Their output is not shown.
/// @returns the exit code: 1 if the second program is slower beyond the resolution
/// @throws InputError if a program fails, or if a file cannot be written
int compare_programs(const ProgramPair& pair);

} // namespace dss
