#include "experiments/base/interrupt.hpp"
#include "solver/io/temporaries.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <unistd.h>

namespace dss {
namespace {

constexpr std::array<int, 3> signals = {SIGINT, SIGTERM, SIGHUP};
constexpr std::time_t patience_s = 10;

// A handler may use atomic numbers and plain bytes alone.
std::atomic<pid_t> child_of_process = 0;
std::atomic<int> pending = 0; ///< the first signal that came
std::atomic<std::time_t> pending_since = 0;
std::atomic<bool> prints = false;
std::array<char, 512> line = {
    "dssbench: interrupted: nothing was written; give the command again\n"};
std::atomic<std::size_t> line_size = std::strlen(line.data());

/// Ends the process by the signal, so that its parent sees why it ended.
void end_by(int signal) {
  remove_temporaries();
  if (prints && ::write(STDERR_FILENO, line.data(), line_size) < 0) prints = false;
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

void on_signal(int signal) {
  const int error = errno;
  const pid_t child = child_of_process;
  const bool is_first = pending.exchange(signal) == 0;
  if (is_first) pending_since = ::time(nullptr);
  if (child > 0 && is_first)
    ::kill(child, SIGTERM);
  else
    end_by(signal);
  errno = error;
}

} // namespace

void handle_interrupts(bool is_silent) {
  prints = !is_silent;
  for (const int signal : signals) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
}

void say_when_interrupted(const std::string& what) {
  std::string text = "dssbench: interrupted";
  if (!what.empty()) text += ": " + what.substr(0, 400);
  text += '\n';
  line_size = 0; // a signal between here and the end prints nothing
  std::copy(text.begin(), text.end(), line.begin());
  line_size = text.size();
}

InterruptedChild::InterruptedChild(pid_t child) {
  child_of_process = child;
  if (pending != 0) ::kill(child, SIGTERM); // it came before the child was known
}

InterruptedChild::~InterruptedChild() { child_of_process = 0; }

bool InterruptedChild::is_overdue() const {
  return pending != 0 && ::time(nullptr) - pending_since > patience_s;
}

void InterruptedChild::end_if_interrupted() {
  if (pending != 0) end_by(pending);
}

} // namespace dss
