#pragma once
/// CPU use of a timed region, as the operating system reports it. It shows if other work took the
/// processor away.
#include <chrono>
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
  /// Time that everything else on this machine ran [s], to some 0.01 s, and so also below 0; NaN if
  /// it is not known.
  double others_s = 0;
  long involuntary_switches = 0;
  Usage& operator+=(const Usage& other);
};

/// CPU time of all children of this process that have ended [s].
double children_cpu_s();

/// Measures the usage of this process since the meter was made (getrusage,
/// /proc/self/task/*/schedstat, and steal and idle time of /proc/stat in ticks of 10 ms). Reading
/// the queues is slow, so it is done outside the region of the CPU time at both ends.
class UsageMeter {
public:
  UsageMeter();
  Usage read() const;

private:
  /// What the counters say at a moment. Between two readings the processors ran this process,
  /// something else or nothing.
  struct Reading {
    Usage usage;
    double idle_s = 0; ///< of all processors
    int processors = 0;
    std::chrono::steady_clock::time_point when;
  };
  /// All but the time in run queues.
  static Reading reading();

  Reading start_;
};

/// True if other work disturbed a timed region (DESIGN.md section 6): workers waited for a
/// processor, or the hypervisor took it, for more than 1 % of wall_s x workers. A worker that waits
/// for another worker is no sign, whether it spins or sleeps. A single worker has nobody to wait
/// for: it is also contaminated if its CPU time is below 0.97 wall_s. (Not below 20 ms, because the
/// clock of getrusage is too coarse.)
/// @param workers  threads that compute on all ranks, see Executor::workers()
/// @param waits    true if workers wait for a device that has threads of its own on their
///     processors. Then they wait for each other as well, and no more than others ran counts, less
///     its resolution of 0.01 s.
bool is_contaminated(const Usage& usage, double wall_s, int workers, bool waits = false);

} // namespace dss
