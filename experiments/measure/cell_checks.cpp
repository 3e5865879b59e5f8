#include "experiments/measure/cell_checks.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {

std::string KeyedFiles::file_of(const std::string& key, const std::string& extension,
                                const std::function<std::string(const std::string& path)>& key_in,
                                const std::function<void(const std::string& path)>& make) {
  const std::string path =
      fmt::format("{}/{:016x}.{}", directory_, std::hash<std::string>{}(key), extension);
  if (made_.contains(path)) return path;
  const bool is_there = keeps_ && std::filesystem::exists(path);
  if (!is_there || key_in(path) != key) make(path);
  made_.insert(path);
  return path;
}

} // namespace dss
