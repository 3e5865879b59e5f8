#include "experiments/base/child.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/base/interrupt.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <optional>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dss {
namespace {

/// Two pipes that become standard output and standard error of a child process.
class Pipes {
public:
  Pipes() {
    if (::pipe2(output_.data(), O_CLOEXEC) != 0 || ::pipe2(error_.data(), O_CLOEXEC) != 0)
      throw InputError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  Pipes(const Pipes&) = delete;
  Pipes& operator=(const Pipes&) = delete;
  ~Pipes() {
    for (const int end : {output_[0], output_[1], error_[0], error_[1]})
      if (end >= 0) ::close(end);
  }
  void close_writing_ends() {
    ::close(output_[1]);
    ::close(error_[1]);
    output_[1] = error_[1] = -1;
  }
  std::array<int, 2> output_{-1, -1}, error_{-1, -1};
};

pid_t spawn(const std::string& program, const std::vector<std::string>& arguments,
            const Pipes& pipes, const InterruptsBlocked& blocked, bool has_own_group) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  if (::access(program.c_str(), X_OK) != 0)
    throw InputError(fmt::format("{}: cannot start: {}", program, std::strerror(errno)));
  const pid_t parent = ::getpid(), pid = ::fork();
  if (pid < 0) throw InputError(fmt::format("{}: cannot start: {}", program, std::strerror(errno)));
  if (pid > 0) return pid;
  // The child must end with its parent. Otherwise it would have no time limit and disturb the next
  // measurement.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (has_own_group) ::setpgid(0, 0);
  blocked.reset_in_child();
  if (::getppid() != parent) ::_exit(127);
  ::dup2(::open("/dev/null", O_RDONLY), 0);
  ::dup2(pipes.output_[1], 1);
  ::dup2(pipes.error_[1], 2);
  ::execv(program.c_str(), argv.data());
  ::_exit(127);
}

/// Longest wait [s] between two looks at whether a child that was asked to end must be killed.
constexpr double longest_wait_s = 1;

/// Reads both pipes until they end or the limit is reached. Returns true if they ended.
bool drain(const Pipes& pipes, InterruptedChild& child, Clock::time_point start, double limit_s,
           ChildResult& result) {
  std::array<pollfd, 2> ends = {{{pipes.output_[0], POLLIN, 0}, {pipes.error_[0], POLLIN, 0}}};
  const std::array<std::string*, 2> texts = {&result.output, &result.error};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    const double left_s = limit_s - seconds_since(start);
    if (left_s <= 0 || child.is_overdue()) return false;
    if (::poll(ends.data(), ends.size(), int(std::min(left_s, longest_wait_s) * 1000 + 1)) < 0 &&
        errno != EINTR)
      return false;
    for (std::size_t e = 0; e < ends.size(); ++e) {
      if (ends[e].fd < 0 || ends[e].revents == 0) continue;
      char bytes[65536];
      const ssize_t count = ::read(ends[e].fd, bytes, sizeof bytes);
      if (count > 0) texts[e]->append(bytes, std::size_t(count));
      // poll skips negative descriptors
      else if (count == 0 || errno != EINTR)
        ends[e].fd = -1;
    }
  }
  return true;
}

} // namespace

std::string ChildResult::failure(double time_limit_s) const {
  if (timed_out) return fmt::format("time limit of {:g} s", time_limit_s);
  if (signal != 0) return fmt::format("signal {} ({})", signal, ::strsignal(signal));
  if (exit_code == 0) return {};
  const std::string line = error.substr(0, error.find('\n'));
  return line.empty() ? fmt::format("exit code {}", exit_code)
                      : fmt::format("exit code {}: {}", exit_code, line);
}

ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                      double time_limit_s, bool has_own_group) {
  ChildResult result;
  const Clock::time_point start = Clock::now();
  Pipes pipes;
  pid_t pid = 0;
  std::optional<InterruptedChild> child;
  {
    const InterruptsBlocked blocked;
    pid = spawn(program, arguments, pipes, blocked, has_own_group);
    // Whoever waits for a child that waits for its own child has more patience.
    child.emplace(pid, has_own_group ? 10 : 15);
  }
  pipes.close_writing_ends();
  result.timed_out = !drain(pipes, *child, start, time_limit_s, result);
  int status = 0;
  // a child may close its outputs and continue: the limit holds for its whole life
  if (!result.timed_out) {
    while (::waitpid(pid, &status, WNOHANG) == 0) {
      if (seconds_since(start) > time_limit_s || child->is_overdue()) {
        result.timed_out = true;
        break;
      }
      ::usleep(500);
    }
  }
  if (result.timed_out) {
    ::kill(has_own_group ? -pid : pid, SIGKILL);
    while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
  }
  child.reset(); // ends this process, too, if a signal came
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status) && !result.timed_out) result.signal = WTERMSIG(status);
  result.wall_s = seconds_since(start);
  return result;
}

} // namespace dss
