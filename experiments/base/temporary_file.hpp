#pragma once
/// Temporary files for programs that this program starts.
#include <string>

namespace dss {

/// A file in the directory of temporary files ($TMPDIR), which the destructor removes.
class TemporaryFile {
public:
  /// @throws InputError if it cannot be made, or cannot be written completely
  TemporaryFile(const std::string& text, const std::string& suffix);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

} // namespace dss
