#include "experiments/base/usage.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>

namespace dss {
namespace {

double seconds(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

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

double steal_s() {
  std::ifstream stream("/proc/stat");
  std::string cpu;
  double user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, soft_irq = 0, steal = 0;
  stream >> cpu >> user >> nice >> system >> idle >> io >> irq >> soft_irq >> steal;
  return stream ? steal / double(::sysconf(_SC_CLK_TCK)) : 0;
}

void read_processor(Usage& usage) {
  rusage self{};
  ::getrusage(RUSAGE_SELF, &self);
  usage.cpu_s = seconds(self.ru_utime) + seconds(self.ru_stime);
  usage.involuntary_switches = self.ru_nivcsw;
}

} // namespace

Usage& Usage::operator+=(const Usage& other) {
  cpu_s += other.cpu_s;
  wait_s += other.wait_s;
  steal_s += other.steal_s;
  involuntary_switches += other.involuntary_switches;
  return *this;
}

UsageMeter::UsageMeter() {
  start_.wait_s = queue_wait_s();
  start_.steal_s = steal_s();
  read_processor(start_);
}

Usage UsageMeter::read() const {
  Usage now;
  read_processor(now);
  now.wait_s = queue_wait_s();
  now.steal_s = steal_s();
  return {now.cpu_s - start_.cpu_s, now.wait_s - start_.wait_s, now.steal_s - start_.steal_s,
          now.involuntary_switches - start_.involuntary_switches};
}

bool is_contaminated(const Usage& usage, double wall_s, int workers, bool waits) {
  const double available_s = wall_s * workers;
  if (available_s <= 0) return false;
  const bool is_starved =
      !waits && workers == 1 && wall_s >= 0.02 && usage.cpu_s / available_s < 0.97;
  const double wait_s = std::isnan(usage.wait_s) ? 0 : usage.wait_s;
  return is_starved || wait_s + usage.steal_s > 0.01 * available_s;
}

} // namespace dss
