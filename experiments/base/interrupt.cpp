#include "experiments/base/interrupt.hpp"
#include "solver/io/temporaries.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fmt/format.h>
#include <fstream>
#include <mutex>
#include <unistd.h>
#include <utility>
#include <vector>

namespace dss {
namespace {

constexpr std::array<int, 3> signals = {SIGINT, SIGTERM, SIGHUP};
/// Signals that come so soon after the first [s] are its copies: `timeout` signals the process and
/// then its group.
constexpr std::time_t copies_s = 2;

// A handler may use atomic numbers and plain bytes alone.
std::array<std::atomic<pid_t>, 64> children{};
std::atomic<int> pending = 0; ///< the first signal that came
std::atomic<std::time_t> pending_since = 0;
std::atomic<bool> prints = false;
std::atomic<bool> is_deferred = false;
std::atomic<bool> is_for_ranks = false;
double time_to_save_s = 0; ///< of ranks
std::array<char, 512> parting_line = {
    "dssbench: interrupted: its files are old or whole; give the command again\n"};
std::atomic<std::size_t> parting_size = std::strlen(parting_line.data());
std::mutex of_line; ///< between threads; the handler does without

/// Ends the process by the signal, so that its parent sees why it ended.
void end_by(int signal) {
  remove_temporaries();
  if (prints && ::write(STDERR_FILENO, parting_line.data(), parting_size) < 0) prints = false;
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

/// @return whether there are children
bool pass_on() {
  bool has_children = false;
  for (const auto& child : children)
    if (const pid_t pid = child; pid > 0) {
      has_children = true;
      if (!is_for_ranks) ::kill(pid, SIGTERM);
    }
  return has_children;
}

void on_signal(int signal) {
  const int error = errno;
  const std::time_t now = ::time(nullptr);
  if (pending == 0) {
    pending_since = now;
    pending = signal;
    if (!is_deferred && !pass_on()) end_by(signal);
  } else if (now - pending_since > copies_s) {
    end_by(signal);
  }
  errno = error;
}

/// Children of a process, without those that have ended and that it has not noticed.
std::vector<pid_t> living_children(pid_t parent) {
  std::ifstream list(fmt::format("/proc/{0}/task/{0}/children", parent));
  std::vector<pid_t> living;
  for (pid_t child = 0; list >> child;) {
    std::ifstream file(fmt::format("/proc/{}/stat", child));
    std::string stat;
    std::getline(file, stat);
    const std::size_t name_end = stat.rfind(')'); // the state follows
    if (name_end != std::string::npos && stat.compare(name_end, 3, ") Z") != 0)
      living.push_back(child);
  }
  return living;
}

void handle(int signal) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, nullptr);
}

} // namespace

void handle_interrupts(bool is_silent) {
  prints = !is_silent;
  for (const int signal : signals) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) handle(signal);
  }
}

void say_when_interrupted(const std::string& what) {
  const std::string text = "dssbench: interrupted: " + what.substr(0, 400) + '\n';
  const std::lock_guard lock(of_line);
  parting_size = 0; // a signal between here and the end prints nothing
  std::copy(text.begin(), text.end(), parting_line.begin());
  parting_size = text.size();
}

InterruptsDeferred::InterruptsDeferred() {
  is_deferred = true;
  handle(SIGUSR1);
}

InterruptsDeferred::~InterruptsDeferred() {
  is_deferred = false;
  if (pending != 0) end_by(pending);
  std::signal(SIGUSR1, SIG_DFL);
}

bool InterruptsDeferred::is_asked() const { return pending != 0; }

void InterruptsDeferred::end(const std::string& what) const {
  say_when_interrupted(what);
  if (!prints) { // a rank
    remove_temporaries();
    ::_exit(EXIT_SUCCESS);
  }
  end_by(pending);
  ::_exit(128 + pending); // the signal was ignored
}

void let_ranks_save(double patience_s) {
  time_to_save_s = patience_s;
  is_for_ranks = true;
}

InterruptsBlocked::InterruptsBlocked() {
  sigset_t blocked;
  ::sigemptyset(&blocked);
  for (const int signal : signals) ::sigaddset(&blocked, signal);
  ::pthread_sigmask(SIG_BLOCK, &blocked, &before_);
}

InterruptsBlocked::~InterruptsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

void InterruptsBlocked::reset_in_child() const {
  for (const int signal : signals) {
    struct sigaction action {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler == on_signal) std::signal(signal, SIG_DFL);
  }
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

InterruptedChild::InterruptedChild(pid_t child, double patience_s)
    : child_(child), patience_s_(patience_s) {
  for (auto& place : children) {
    pid_t expected = 0;
    if (place.compare_exchange_strong(expected, child_)) return;
  }
}

InterruptedChild::~InterruptedChild() {
  for (auto& place : children) {
    pid_t expected = child_;
    if (place.compare_exchange_strong(expected, 0)) break;
  }
  if (pending != 0) end_by(pending);
}

bool InterruptedChild::is_overdue() {
  if (pending == 0) return false;
  const std::time_t now = ::time(nullptr);
  if (is_for_ranks) {
    const std::vector<pid_t> ranks = living_children(child_);
    if (!std::exchange(has_told_, true)) {
      for (const pid_t rank : ranks) ::kill(rank, SIGUSR1);
      if (ranks.empty()) ::kill(child_, SIGTERM);
    }
    if (!ranks.empty()) ranks_lived_ = now;
    if (double(now - pending_since) <= time_to_save_s && !ranks.empty()) return false;
  }
  return double(now - std::max<std::time_t>(pending_since, ranks_lived_)) > patience_s_;
}

} // namespace dss
