#pragma once
/// What the operating system says of a timed region: was the processor ours all the time?
#include <cmath>

namespace dss {

/// Sums over all threads of this process.
struct Usage {
  double cpu_s = 0;  ///< user and system time [s]
  double wait_s = 0; ///< runnable but not running, in a run queue [s]; NaN where the kernel does not tell
  long involuntary_switches = 0;
  Usage& operator+=(const Usage& other);
};

/// Usage of this process since the meter was made (getrusage; /proc/self/task/*/schedstat). The slow reading of the
/// queues is outside of the CPU time's region at both ends.
class UsageMeter {
public:
  UsageMeter();
  Usage read() const;

private:
  Usage start_;
};

/// A timed region's cleanliness (DESIGN.md section 6): CPU time / (wall x workers) below 0.97, or more than a hundredth
/// of wall x workers spent waiting for a processor, and the sample is contaminated. Workers are the threads that compute, see Executor::workers(). Regions shorter than the clock of
/// getrusage can tell (20 ms) are judged by their waiting alone.
bool is_contaminated(const Usage& usage, double wall_s, int workers);

} // namespace dss
