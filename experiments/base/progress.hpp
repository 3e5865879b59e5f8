#pragma once
/// Progress of a long command, on standard error: a bar with the remaining time on a terminal, else
/// plain lines.
#include <chrono>
#include <string>

namespace dss {

/// Shows progress until it is destroyed.
class Progress {
public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  /// Shows that `done` of `total` is done (in any unit), and the item done last.
  void show(double done, double total, const std::string& what);
  bool is_terminal() const { return is_terminal_; }
  /// Prints a line that stays above the bar.
  void note(const std::string& line);

private:
  void clear();
  bool is_terminal_;
  bool is_bar_shown_ = false;
  std::chrono::steady_clock::time_point start_;
};

/// A duration as text: "45 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

} // namespace dss
