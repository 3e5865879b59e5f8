#pragma once
/// Files of states. Line 1 names the format, line 2 is a key, line 3 has figures. The doubles
/// follow as they are in memory.
#include <span>
#include <string>
#include <vector>

namespace dss {

/// The content of a file of states.
struct StateFile {
  std::string key;            ///< what the states belong to
  std::string figures;        ///< third line
  std::vector<double> values; ///< all states, one after the other
};

/// @param states  written one after the other
/// @throws InputError if the file cannot be written completely; an existing file then stays
void write_state_file(const std::string& path, const std::string& format, const std::string& key,
                      const std::string& figures, std::span<const std::vector<double>> states);

/// @param what  for error messages: "is no oracle state"
/// @throws InputError for another format, or if the last number is cut off
StateFile read_state_file(const std::string& path, const std::string& format,
                          const std::string& what);

/// Error for a file whose number of values does not match its figures.
[[noreturn]] void fail_cut_off(const std::string& path);

} // namespace dss
