#pragma once
/// Files of states: a line that names the format, one with a key, one of figures, then doubles as they are in memory.
#include <span>
#include <string>
#include <vector>

namespace dss {

struct StateFile {
  std::string key;            ///< what the states are of
  std::string figures;        ///< third line
  std::vector<double> values; ///< all states, one after the other
};

/// @param states  one after the other. @throws InputError if the file cannot be written whole; an earlier one then stays
void write_state_file(const std::string& path, const std::string& format, const std::string& key,
                      const std::string& figures, std::span<const std::vector<double>> states);

/// @param what  for errors: "is no oracle state". @throws InputError for another format, and for a last number that is cut
StateFile read_state_file(const std::string& path, const std::string& format, const std::string& what);

/// For a file with fewer or more values than its figures say.
[[noreturn]] void fail_cut_off(const std::string& path);

} // namespace dss
