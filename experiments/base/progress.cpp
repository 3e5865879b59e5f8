#include "experiments/base/progress.hpp"
#include "experiments/base/clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace dss {

std::string duration_text(double seconds) {
  const long s = std::lround(std::max(seconds, 0.0));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

Progress::Progress() : is_terminal_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (is_bar_shown_) std::fputs("\r\033[K", stderr);
  is_bar_shown_ = false;
}

void Progress::show(double done, double total, const std::string& what) {
  const double share = total > 0 ? std::clamp(done / total, 0.0, 1.0) : 1;
  const double elapsed = seconds_since(start_);
  const std::string left = share > 0 ? duration_text(elapsed / share * (1 - share)) + " left" : "";
  if (!is_terminal_) {
    fmt::print(stderr, "{:3.0f} %  {}  {}\n", 100 * share, what, left);
    return;
  }
  constexpr int width = 30;
  const int filled = int(share * width);
  clear();
  fmt::print(stderr, "[{:#<{}}{:.<{}}] {:3.0f} %  {}  {}", "", filled, "", width - filled,
             100 * share, left, what);
  std::fflush(stderr);
  is_bar_shown_ = true;
}

void Progress::note(const std::string& line) {
  clear();
  fmt::print(stderr, "{}\n", line);
}

} // namespace dss
