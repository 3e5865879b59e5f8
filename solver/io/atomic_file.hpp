#pragma once
/// Files that appear whole or not at all. They are written to a temporary file beside the target
/// and then renamed.
#include <string>
#include <string_view>

namespace dss {

/// A file under construction. Without commit() nothing is left behind, and an earlier file stays
/// unchanged. A target that exists and is not a regular file (a pipe, a terminal, /dev/full) is
/// written in place.
class AtomicFile {
public:
  /// @throws InputError if the file cannot be created: one line with the path and the reason
  explicit AtomicFile(std::string target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Appends bytes.
  /// @throws InputError if they cannot be written (disk full, limit on file size, ...)
  void write(std::string_view bytes);
  /// Flushes, checks and closes the file, which is then safe on the disk under its temporary name.
  /// @throws InputError as write
  void finish();
  /// Finishes the file and moves it to its target.
  /// @throws InputError as write
  void commit();

  const std::string& target() const { return target_; }
  /// As commit(), but an earlier file stays until the end of this object, so that it can come back.
  /// @throws InputError as write
  void move();
  /// Undoes move(): the earlier file is at its target again. Some file systems cannot exchange two
  /// files; there it is lost.
  void move_back();

private:
  void flush();
  bool exchange() const;
  [[noreturn]] void fail(const char* what, int reason) const;

  std::string target_;
  std::string temporary_; ///< removed at the end, unless empty; after move() the earlier file
  bool is_new_ = false;   ///< moved to where there was no file
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes all bytes to an open file. @return 0, or the errno of the write that failed
int write_all(int descriptor, std::string_view bytes);

/// Checks, before a long computation, that a file can be created at `target`. Leaves nothing
/// behind.
/// @throws InputError if it cannot
void require_writable(const std::string& target);

/// Returns the whole text of a file.
/// @throws InputError if it cannot be read
std::string read_text(const std::string& path);

} // namespace dss
