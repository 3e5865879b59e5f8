#pragma once
/// Temporary files for programs that this program starts.
#include <atomic>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <unistd.h>

namespace dss {

/// A file that the destructor removes.
class TemporaryFile {
public:
  TemporaryFile(const std::string& text, const std::string& suffix) {
    path_ = (std::filesystem::temp_directory_path() /
             fmt::format("dssbench-{}-{}{}", ::getpid(), ++count_, suffix))
                .string();
    std::ofstream(path_) << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  const std::string& path() const { return path_; }

private:
  static inline std::atomic<int> count_ = 0;
  std::string path_;
};

} // namespace dss
