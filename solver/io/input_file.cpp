#include "solver/io/input_file.hpp"

#include "solver/error.hpp"
#include "solver/memory.hpp"

#include <fmt/format.h>

#include <system_error>

namespace dss {

std::ifstream open_whole(const std::filesystem::path& path, double share, const std::string& what,
                         const std::string& advice) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  require_memory(share * double(std::filesystem::file_size(path, error)), what, advice);
  return std::ifstream(path, std::ios::binary);
}

std::string bytes_of(const std::string& kind, const std::string& path) {
  std::ifstream file = open_whole(path, 5, fmt::format("{} {}", kind, path), "give a smaller one");
  const auto fail = [&] { throw InputError(fmt::format("{} {}: cannot be read", kind, path)); };
  if (!file.is_open()) fail();
  std::string bytes(std::filesystem::file_size(path), '\0');
  if (!file.read(bytes.data(), std::streamsize(bytes.size()))) fail();
  return bytes;
}

} // namespace dss
