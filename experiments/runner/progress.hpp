#pragma once
/// How far a long command is, on standard error: a bar with the time left on a terminal, plain lines otherwise.
#include <chrono>
#include <string>

namespace dss {

class Progress {
public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  /// Shows that `done` of `total` is done (any unit) and what was done last.
  void show(double done, double total, const std::string& what);
  /// A line that stays, above the bar.
  void note(const std::string& line);

private:
  void clear();
  bool is_terminal_;
  bool is_bar_shown_ = false;
  std::chrono::steady_clock::time_point start_;
};

/// "45 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

} // namespace dss
