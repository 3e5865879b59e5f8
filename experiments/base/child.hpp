#pragma once
/// Runs other programs. Each repetition of a cell is a child process, so a crash costs only that
/// repetition.
#include <string>
#include <vector>

namespace dss {

/// How a child process ended.
struct ChildResult {
  bool timed_out = false;
  int exit_code = -1; ///< valid if it exited
  int signal = 0;     ///< signal that ended it, or 0
  double wall_s = 0;  ///< time from start to end [s]
  std::string output, error;
  /// Reason of a failure: "exit code 3: ...", "time limit of 60 s", "signal 11 (Segmentation
  /// fault)". Empty on success.
  std::string failure(double time_limit_s) const;
};

/// Path of this program itself, to start it again.
constexpr const char* this_program = "/proc/self/exe";

/// Runs a program and waits for it, at most `time_limit_s` [s]; then it is killed.
/// @param arguments  the first one is the program's name
/// @param has_own_group  Ctrl-C does not reach the child, but this program passes it on: mpirun
/// takes a second signal as a wish to end without tidying up
/// @throws InputError if the program cannot be started
ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                      double time_limit_s, bool has_own_group = false);

} // namespace dss
