#pragma once
/// CPU use of a timed region, as the operating system reports it. It shows if other work took the
/// processor away.
#include <cmath>

namespace dss {

/// Sums over all threads of this process, and over the processors of the machine.
struct Usage {
  double cpu_s = 0; ///< user and system time [s]
  /// Time in a run queue, runnable but not running [s]; NaN if the kernel does not report it.
  double wait_s = 0;
  /// Time that the hypervisor took from the processors of this machine while they had work [s]; 0
  /// on a machine that is not virtual.
  double steal_s = 0;
  long involuntary_switches = 0;
  Usage& operator+=(const Usage& other);
};

/// Measures the usage of this process since the meter was made (getrusage,
/// /proc/self/task/*/schedstat, and the steal of /proc/stat in ticks of 10 ms). Reading the queues
/// is slow, so it is done outside the region of the CPU time at both ends.
class UsageMeter {
public:
  UsageMeter();
  Usage read() const;

private:
  Usage start_;
};

/// True if other work disturbed a timed region (DESIGN.md section 6): workers waited for a
/// processor, or the hypervisor took it, for more than 1 % of wall_s x workers. A worker that waits
/// for another worker is no sign, whether it spins or sleeps. A single worker has nobody to wait
/// for: it is also contaminated if its CPU time is below 0.97 wall_s. (Not below 20 ms, because the
/// clock of getrusage is too coarse.)
/// @param workers  threads that compute on all ranks, see Executor::workers()
/// @param waits    true if a single worker waits too, for a device that has threads of its own
bool is_contaminated(const Usage& usage, double wall_s, int workers, bool waits = false);

} // namespace dss
