#include "experiments/base/usage.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>

namespace dss {
namespace {

/// of Usage::others_s: a tick [s]
constexpr double others_resolution_s = 0.01;

double seconds(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }
double cpu_s(const rusage& used) { return seconds(used.ru_utime) + seconds(used.ru_stime); }

double queue_wait_s() {
  double sum = 0;
  bool is_known = false;
  std::error_code error;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", error)) {
    std::ifstream stream(task.path() / "schedstat");
    double running_ns = 0, waiting_ns = 0;
    if (stream >> running_ns >> waiting_ns) {
      sum += waiting_ns;
      is_known = true;
    }
  }
  return is_known ? 1e-9 * sum : std::numeric_limits<double>::quiet_NaN();
}

/// Times of all processors together [s], in ticks.
struct ProcessorTimes {
  double idle_s = 0, steal_s = 0;
  int processors = 0; ///< 0: unknown
};

ProcessorTimes processor_times() {
  std::ifstream stream("/proc/stat");
  std::string word;
  double user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, soft_irq = 0, steal = 0;
  stream >> word >> user >> nice >> system >> idle >> io >> irq >> soft_irq >> steal;
  if (!stream) return {};
  const double ticks_per_s = double(::sysconf(_SC_CLK_TCK));
  return {(idle + io) / ticks_per_s, steal / ticks_per_s, int(::sysconf(_SC_NPROCESSORS_ONLN))};
}

void read_processor(Usage& usage) {
  rusage self{};
  ::getrusage(RUSAGE_SELF, &self);
  usage.cpu_s = cpu_s(self);
  usage.involuntary_switches = self.ru_nivcsw;
}

} // namespace

Usage& Usage::operator+=(const Usage& other) {
  cpu_s += other.cpu_s;
  wait_s += other.wait_s;
  steal_s += other.steal_s;
  others_s += other.others_s;
  involuntary_switches += other.involuntary_switches;
  return *this;
}

double children_cpu_s() {
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  return cpu_s(children);
}

UsageMeter::Reading UsageMeter::reading() {
  Reading now;
  read_processor(now.usage);
  now.when = std::chrono::steady_clock::now();
  const ProcessorTimes times = processor_times();
  now.usage.steal_s = times.steal_s;
  now.idle_s = times.idle_s;
  now.processors = times.processors;
  return now;
}

UsageMeter::UsageMeter() {
  const double wait_s = queue_wait_s();
  start_ = reading();
  start_.usage.wait_s = wait_s;
}

Usage UsageMeter::read() const {
  Reading now = reading();
  now.usage.wait_s = queue_wait_s();
  const Usage &end = now.usage, &start = start_.usage;
  Usage used{end.cpu_s - start.cpu_s, end.wait_s - start.wait_s, end.steal_s - start.steal_s,
             std::numeric_limits<double>::quiet_NaN(),
             end.involuntary_switches - start.involuntary_switches};
  const double elapsed_s = std::chrono::duration<double>(now.when - start_.when).count();
  if (now.processors > 0)
    used.others_s =
        now.processors * elapsed_s - (now.idle_s - start_.idle_s) - used.steal_s - used.cpu_s;
  return used;
}

bool is_contaminated(const Usage& usage, double wall_s, int workers, bool waits) {
  const double available_s = wall_s * workers;
  if (available_s <= 0) return false;
  const bool is_starved =
      !waits && workers == 1 && wall_s >= 0.02 && usage.cpu_s / available_s < 0.97;
  double wait_s = std::isnan(usage.wait_s) ? 0 : usage.wait_s;
  if (waits && !std::isnan(usage.others_s))
    wait_s = std::min(wait_s, std::max(0.0, usage.others_s - others_resolution_s));
  return is_starved || wait_s + usage.steal_s > 0.01 * available_s;
}

} // namespace dss
