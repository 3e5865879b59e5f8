#pragma once
/// Ctrl-C and other requests to end (SIGINT, SIGTERM, SIGHUP). They end the process as before, but
/// first its child ends, temporary files are removed, and one line says how to go on. A run that
/// saves itself ends later (InterruptsDeferred).
#include <csignal>
#include <ctime>
#include <string>
#include <sys/types.h>

namespace dss {

/// Installs the handlers. Signals that are ignored stay ignored (nohup).
/// @param is_silent  prints nothing: the process is a rank, and its launcher prints
void handle_interrupts(bool is_silent);

/// What the line says after "interrupted: "; at most 400 characters.
void say_when_interrupted(const std::string& what);

/// As long as it lives, the first signal asks only: whoever sees that saves its work and calls
/// end(). A second signal, after two seconds, ends the process at once. SIGUSR1 asks too: launchers
/// and batch systems send it.
class InterruptsDeferred {
public:
  InterruptsDeferred();
  InterruptsDeferred(const InterruptsDeferred&) = delete;
  InterruptsDeferred& operator=(const InterruptsDeferred&) = delete;
  /// Ends the process if a signal came that nobody saw.
  ~InterruptsDeferred();
  bool is_asked() const;
  /// Ends the process by the signal that came; a rank by exit code 0, since mpirun may hang after a
  /// rank that a signal ended, and its launcher ends by the signal.
  /// @param what  the line says it after "interrupted: "
  [[noreturn]] void end(const std::string& what) const;
};

/// From now on a signal goes as SIGUSR1 to the children of this process's child, which have this
/// time [s] to save their work. mpirun kills its ranks one second after a SIGTERM, and that of Open
/// MPI 4.1.4 did not pass SIGUSR1 on in a trial, although its manual says so. Ranks of other
/// machines hear of it from those of this one.
void let_ranks_save(double patience_s);

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
  /// Call it again and again while waiting for the child: it tells ranks of a signal that came.
  /// @return true if the child was asked to end, and so long ago that it should be killed
  bool is_overdue();

private:
  pid_t child_;
  double patience_s_;
  bool has_told_ = false;
  std::time_t ranks_lived_ = 0; ///< when a rank lived last
};

} // namespace dss
