#pragma once
/// Gives the bytes of libFuzzer to the readers of this program. A reader answers with a value or an
/// InputError; a crash, a sanitizer's report, another exception or a long wait is a mistake.
#include "solver/error.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <unistd.h>

namespace dss {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Calls `read()`. @return 0, as libFuzzer expects
template <class Read>
int answered(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
  return 0;
}

/// Calls `read(path)` of a file with these bytes. The suffix is part of its name, since some
/// readers choose a format by it.
template <class Read>
int answered_for_file(const std::uint8_t* data, std::size_t size, const std::string& suffix,
                      const Read& read) {
  static const std::string path = (std::filesystem::temp_directory_path() /
                                   fmt::format("dssbench-fuzz-{}{}", ::getpid(), suffix))
                                      .string();
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text_of(data, size);
  return answered([&] { read(path); });
}

} // namespace dss
