#pragma once
/// Ctrl-C and other requests to end (SIGINT, SIGTERM, SIGHUP). They end the process as before, but
/// first its child ends, temporary files are removed, and one line says how to go on.
#include <string>
#include <sys/types.h>

namespace dss {

/// Installs the handlers. Signals that are ignored stay ignored (nohup).
/// @param is_silent  prints nothing: the process is a rank, and its launcher prints
void handle_interrupts(bool is_silent);

/// What the line says after "interrupted: "; at most 400 characters. Not for several threads.
void say_when_interrupted(const std::string& what);

/// The child of this process. A signal goes on to it, and the process ends after it: `mpirun`
/// removes the ranks' shared memory when it ends by a signal.
class InterruptedChild {
public:
  explicit InterruptedChild(pid_t child);
  InterruptedChild(const InterruptedChild&) = delete;
  InterruptedChild& operator=(const InterruptedChild&) = delete;
  ~InterruptedChild();
  /// True if the child was asked to end, and so long ago that it should be killed.
  bool is_overdue() const;
  /// Ends this process if a signal came. Call it when the child has ended.
  static void end_if_interrupted();
};

} // namespace dss
