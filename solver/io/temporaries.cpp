#include "solver/io/temporaries.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dss {
namespace {

constexpr std::size_t most_files = 64, most_characters = 4096;

enum place_state : int { is_free, is_changing, is_used };

/// A signal handler may neither lock nor allocate, so the names lie in a fixed table. Files that do
/// not fit are not removed after a signal.
struct Place {
  std::atomic<int> state = is_free;
  std::array<char, most_characters> path{};
};
std::array<Place, most_files> places;

/// The umask. Reading it means setting it, so it is read once.
mode_t own_umask() {
  static const mode_t mask = [] {
    const mode_t now = ::umask(0);
    ::umask(now);
    return now;
  }();
  return mask;
}

} // namespace

int make_temporary(std::string& pattern, int suffix_length, unsigned mode) {
  const int descriptor = ::mkostemps(pattern.data(), suffix_length, O_CLOEXEC);
  if (descriptor < 0) return descriptor;
  ::fchmod(descriptor, mode & ~own_umask()); // some file systems have no permissions
  remember_temporary(pattern);
  return descriptor;
}

void remember_temporary(const std::string& path) {
  if (path.size() >= most_characters) return;
  for (Place& place : places) {
    int expected = is_free;
    if (!place.state.compare_exchange_strong(expected, is_changing)) continue;
    std::memcpy(place.path.data(), path.c_str(), path.size() + 1);
    place.state = is_used;
    return;
  }
}

void forget_temporary(const std::string& path) {
  for (Place& place : places)
    if (place.state == is_used && path == place.path.data()) place.state = is_free;
}

void remove_temporaries() {
  for (Place& place : places)
    if (place.state == is_used) ::unlink(place.path.data());
}

} // namespace dss
