#pragma once
/// A repetition of a cell runs in a process of its own: a crash or a hang costs that repetition and nothing else.
#include <string>
#include <vector>

namespace dss {

/// What became of a child process.
struct ChildResult {
  bool timed_out = false;
  int exit_code = -1; ///< valid if it exited
  int signal = 0;     ///< that ended it, or 0
  double wall_s = 0;  ///< its whole life [s]
  std::string output, error;
  /// "exit code 3: ...", "time limit of 60 s", "signal 11 (Segmentation fault)"; empty on success.
  std::string failure(double time_limit_s) const;
};

/// Path of this very program, for posix_spawn.
constexpr const char* this_program = "/proc/self/exe";

/// Runs a program with arguments (the first is its name) and waits at most `time_limit_s` [s]; then it is killed.
/// @throws InputError if the program cannot be started
ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments, double time_limit_s);

} // namespace dss
