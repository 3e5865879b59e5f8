#include "variants/opencl/binary_cache.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <sys/stat.h>
#include <unistd.h>

namespace dss::opencl {
namespace {

/// The same in every process of one build of the C++ library. With another build no binaries are
/// found.
std::string hash(std::string_view text) {
  return fmt::format("{:016x}", std::hash<std::string_view>{}(text));
}

std::string file_of(std::string_view key) {
  const std::string directory = cache_directory();
  return directory.empty() ? "" : fmt::format("{}/{}.bin", directory, hash(key));
}

/// The file holds the whole key, so that programs with equal hashes are not confused.
std::string head_of(std::string_view key) {
  return fmt::format("dssbench binary 1\n{}\n{}\n", key.size(), key);
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// True if nobody else can have written there. Drivers run what a binary says.
bool is_own(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && status.st_uid == ::geteuid() &&
         (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

constexpr const char* own_directory = "DSSBENCH_CACHE_DIR";

} // namespace

bool is_cache_asked_for() { return !environment(own_directory).empty(); }

std::string cache_directory() {
  if (is_cache_asked_for()) return environment(own_directory);
  if (const std::string caches = environment("XDG_CACHE_HOME"); !caches.empty())
    return caches + "/dssbench/opencl";
  const std::string home = environment("HOME");
  return home.empty() ? "" : home + "/.cache/dssbench/opencl";
}

std::optional<std::string> load_binary(std::string_view key) {
  const std::string file = file_of(key);
  if (file.empty() || !is_own(cache_directory()) || !is_own(file)) return std::nullopt;
  try {
    const std::string text = read_text(file), head = head_of(key);
    constexpr std::size_t hash_size = 16;
    if (text.size() < head.size() + hash_size || !text.starts_with(head)) return std::nullopt;
    const std::string binary = text.substr(head.size() + hash_size);
    // Checked here, because drivers crash on damaged binaries.
    if (text.compare(head.size(), hash_size, hash(binary)) != 0) return std::nullopt;
    return binary;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void store_binary(std::string_view key, std::string_view binary) {
  const std::string path = file_of(key);
  if (path.empty() || binary.empty()) return;
  std::error_code error;
  if (std::filesystem::create_directories(cache_directory(), error))
    std::filesystem::permissions(cache_directory(), std::filesystem::perms::owner_all, error);
  try {
    AtomicFile file(path);
    file.write(head_of(key));
    file.write(hash(binary));
    file.write(binary);
    file.commit();
    using std::filesystem::perms;
    std::filesystem::permissions(path, perms::owner_read | perms::owner_write, error);
  } catch (const InputError&) { // the program works without it
  }
}

} // namespace dss::opencl
