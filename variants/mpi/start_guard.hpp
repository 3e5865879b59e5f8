#pragma once
/// Guards the start of MPI. Before MPI has started there is no board that shows who waits, and a
/// stopped rank holds up the others in MPI_Init.
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace dss {

/// While it lives, the process ends with one line of error when the patience for MPI's start is
/// used up.
class StartGuard {
public:
  StartGuard();
  ~StartGuard();
  StartGuard(const StartGuard&) = delete;
  StartGuard& operator=(const StartGuard&) = delete;

private:
  void look();
  std::mutex mutex_;
  std::condition_variable started_;
  bool is_started_ = false;
  std::thread thread_;
};

/// How long a rank waits for another [s]: DSSBENCH_PATIENCE_S, or 7. A hung job then ends within 10
/// s, including mpirun's time to end the other ranks.
double patience_s();
/// Prints one line on standard error and ends this process; mpirun then ends the other ranks.
[[noreturn]] void end_job(const std::string& what);

} // namespace dss
