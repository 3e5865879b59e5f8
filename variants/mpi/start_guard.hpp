#pragma once
/// Until MPI has started there is no board to read: a rank that stops before holds the others up in MPI_Init.
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace dss {

/// Ends the process, with one line, if it lives longer than the patience for MPI's start.
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

/// Seconds that a rank waits for another: DSSBENCH_PATIENCE_S, or 7; with what mpirun takes to end the others, a hung job
/// then lasts below 10 s.
double patience_s();
/// Prints a line on standard error and ends this process, upon which mpirun ends the others.
[[noreturn]] void end_job(const std::string& what);

} // namespace dss
