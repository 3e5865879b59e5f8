#include "experiments/run/state/state_file.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <sstream>

namespace dss {

void write_state_file(const std::string& path, const std::string& format, const std::string& key,
                      const std::string& figures, std::span<const std::vector<double>> states) {
  constexpr std::size_t piece = 8192;
  AtomicFile file(path);
  file.write(fmt::format("{}\n{}\n{}\n", format, key, figures));
  for (const std::vector<double>& state : states)
    for (std::size_t first = 0; first < state.size(); first += piece) {
      const std::size_t count = std::min(piece, state.size() - first);
      file.write({reinterpret_cast<const char*>(&state[first]), count * sizeof(double)});
    }
  file.commit();
}

StateFile read_state_file(const std::string& path, const std::string& format,
                          const std::string& what) {
  const std::string text = read_text(path);
  std::istringstream head(text);
  std::string first_line;
  StateFile file;
  std::getline(head, first_line);
  std::getline(head, file.key);
  std::getline(head, file.figures);
  if (first_line != format || !head) throw InputError(fmt::format("{}: {}", path, what));
  const std::size_t begin =
      std::min(text.size(), first_line.size() + file.key.size() + file.figures.size() + 3);
  if ((text.size() - begin) % sizeof(double) != 0) fail_cut_off(path);
  file.values.resize((text.size() - begin) / sizeof(double));
  std::memcpy(file.values.data(), text.data() + begin, file.values.size() * sizeof(double));
  return file;
}

void fail_cut_off(const std::string& path) {
  throw InputError(
      fmt::format("{}: is cut off; delete it, and `dssbench experiment` makes it anew", path));
}

} // namespace dss
