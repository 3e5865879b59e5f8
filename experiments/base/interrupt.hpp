#pragma once
/// Ctrl-C and other requests to end (SIGINT, SIGTERM, SIGHUP). They end the process as before, but
/// first its child ends, temporary files are removed, and one line says how to go on.
#include <csignal>
#include <string>
#include <sys/types.h>

namespace dss {

/// Installs the handlers. Signals that are ignored stay ignored (nohup).
/// @param is_silent  prints nothing: the process is a rank, and its launcher prints
void handle_interrupts(bool is_silent);

/// What the line says after "interrupted: "; at most 400 characters.
void say_when_interrupted(const std::string& what);

/// Blocks the signals in this thread as long as it lives, and gives a forked child the default
/// handlers: a signal between fork and exec is the parent's.
class InterruptsBlocked {
public:
  InterruptsBlocked();
  InterruptsBlocked(const InterruptsBlocked&) = delete;
  InterruptsBlocked& operator=(const InterruptsBlocked&) = delete;
  ~InterruptsBlocked();
  /// In the child, before exec.
  void reset_in_child() const;

private:
  sigset_t before_{};
};

/// A child of this process. A signal goes on to it, and the process ends after it: `mpirun` removes
/// the ranks' shared memory when it ends by a signal. Of several children, the first that ends ends
/// the process.
class InterruptedChild {
public:
  /// @param patience_s  time that the child has to end [s]
  InterruptedChild(pid_t child, double patience_s);
  InterruptedChild(const InterruptedChild&) = delete;
  InterruptedChild& operator=(const InterruptedChild&) = delete;
  ~InterruptedChild();
  /// True if the child was asked to end, and so long ago that it should be killed.
  bool is_overdue() const;

private:
  pid_t child_;
  double patience_s_;
};

} // namespace dss
