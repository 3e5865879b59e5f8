#pragma once
/// Files that appear whole or not at all: written to a temporary beside the target, then renamed.
#include <string>
#include <string_view>

namespace dss {

/// A file under construction. Without commit() nothing is left behind and an earlier file stays as it was.
/// A target that exists and is no regular file (a pipe, a terminal, /dev/full) is written in place.
class AtomicFile {
public:
  /// @throws InputError if the file cannot be created: one line with the path and the reason
  explicit AtomicFile(std::string target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Appends bytes. @throws InputError if they cannot be written (disk full, limit on file size, ...)
  void write(std::string_view bytes);
  /// Flushes, checks, and puts the file in its place. @throws InputError as write
  void commit();

private:
  void flush();
  [[noreturn]] void fail(const char* what, int reason) const;

  std::string target_, temporary_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// Checks before a long computation that a file could be created at `target`; leaves nothing behind.
/// @throws InputError if not
void require_writable(const std::string& target);

/// Whole text of a file. @throws InputError if it cannot be read
std::string read_text(const std::string& path);

} // namespace dss
