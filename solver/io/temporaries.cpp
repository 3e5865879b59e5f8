#include "solver/io/temporaries.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <random>
#include <string_view>
#include <unistd.h>

namespace dss {
namespace {

constexpr std::size_t most_files = 64, most_characters = 4096;
constexpr std::string_view random_place = "XXXXXX";
constexpr std::size_t letters_of_name = 8;
constexpr int most_tries = 100;

enum place_state : int { is_free, is_changing, is_used };

/// A signal handler may neither lock nor allocate, so the names lie in a fixed table, and a place
/// is taken before it is read. Files that do not fit are not removed after a signal.
struct Place {
  std::atomic<int> state = is_free;
  std::array<char, most_characters> path{};

  bool is_taken_from(place_state from) { // by whoever called, until the state is set again
    int expected = from;
    return state.compare_exchange_strong(expected, is_changing);
  }
};
std::array<Place, most_files> places;
std::mutex of_places; ///< between threads; the handler does without

std::string random_letters() {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device device;
  std::uniform_int_distribution<std::size_t> any(0, letters.size() - 1);
  std::string text(letters_of_name, ' ');
  for (char& c : text) c = letters[any(device)];
  return text;
}

} // namespace

int make_temporary(std::string& pattern, unsigned mode) {
  const std::size_t place = pattern.rfind(random_place);
  for (int tries = 0; tries < most_tries; ++tries) {
    std::string path = pattern;
    path.replace(place, random_place.size(), random_letters());
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor < 0 && errno == EEXIST) continue;
    pattern = path;
    if (descriptor >= 0) remember_temporary(path);
    return descriptor;
  }
  return -1;
}

void remember_temporary(const std::string& path) {
  if (path.size() >= most_characters) return;
  const std::lock_guard lock(of_places);
  for (Place& place : places) {
    if (!place.is_taken_from(is_free)) continue;
    std::memcpy(place.path.data(), path.c_str(), path.size() + 1);
    place.state = is_used;
    return;
  }
}

void forget_temporary(const std::string& path) {
  const std::lock_guard lock(of_places);
  for (Place& place : places)
    if (place.is_taken_from(is_used)) place.state = path == place.path.data() ? is_free : is_used;
}

void remove_temporaries() {
  for (Place& place : places)
    if (place.is_taken_from(is_used)) ::unlink(place.path.data());
}

} // namespace dss
