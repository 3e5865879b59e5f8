#pragma once
/// CPU use of a timed region, as the operating system reports it. It shows if other work took the
/// processor away.
#include <cmath>

namespace dss {

/// Sums over all threads of this process.
struct Usage {
  double cpu_s = 0; ///< user and system time [s]
  /// Time in a run queue, runnable but not running [s]; NaN if the kernel does not report it.
  double wait_s = 0;
  long involuntary_switches = 0;
  Usage& operator+=(const Usage& other);
};

/// Measures the usage of this process since the meter was made (getrusage and
/// /proc/self/task/*/schedstat). Reading the queues is slow, so it is done outside the region of
/// the CPU time at both ends.
class UsageMeter {
public:
  UsageMeter();
  Usage read() const;

private:
  Usage start_;
};

/// True if a timed region is contaminated (DESIGN.md section 6): CPU time / (wall_s x workers) is
/// below 0.97, or more than 1 % of wall_s x workers was spent waiting for a processor. Regions
/// shorter than 20 ms are judged by the waiting time only, because the clock of getrusage is too
/// coarse.
/// @param workers  threads that compute, see Executor::workers()
bool is_contaminated(const Usage& usage, double wall_s, int workers);

} // namespace dss
