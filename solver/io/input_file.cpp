#include "solver/io/input_file.hpp"

#include "solver/memory.hpp"

#include <system_error>

namespace dss {

std::ifstream open_whole(const std::filesystem::path& path, double share, const std::string& what,
                         const std::string& advice) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  require_memory(share * double(std::filesystem::file_size(path, error)), what, advice);
  return std::ifstream(path, std::ios::binary);
}

} // namespace dss
