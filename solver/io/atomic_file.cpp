#include "solver/io/atomic_file.hpp"
#include "solver/error.hpp"
#include "solver/io/temporaries.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <unistd.h>

namespace dss {
namespace {

constexpr std::size_t buffer_bytes = std::size_t(1) << 16;

bool is_directory(const std::string& target) {
  struct stat status {};
  return ::stat(target.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

bool is_written_in_place(const std::string& target) {
  struct stat status {};
  return ::stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

} // namespace

AtomicFile::AtomicFile(std::string target) : target_(std::move(target)) {
  if (is_directory(target_)) fail("write", EISDIR);
  if (is_written_in_place(target_)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    temporary_ = target_ + ".XXXXXX.part";
    descriptor_ = make_temporary(temporary_, 0666);
  }
  if (descriptor_ < 0) {
    temporary_.clear();
    fail("write", errno);
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  forget_temporary(temporary_);
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= buffer_bytes) flush();
}

void AtomicFile::flush() {
  if (const int reason = write_all(descriptor_, buffer_); reason != 0) fail("write", reason);
  buffer_.clear();
}

void AtomicFile::finish() {
  if (descriptor_ < 0) return;
  flush();
  // After a loss of power the file is then old or new. Pipes and devices cannot be synced.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0 && errno != EINVAL) fail("write", errno);
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail("write", errno);
}

void AtomicFile::commit() {
  finish();
  if (!temporary_.empty() && ::rename(temporary_.c_str(), target_.c_str()) != 0)
    fail("replace", errno);
  forget_temporary(temporary_);
  temporary_.clear();
}

bool AtomicFile::exchange() const {
  return ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0;
}

void AtomicFile::move() {
  finish();
  if (is_directory(target_)) fail("replace", EISDIR); // a file can be exchanged with one
  if (temporary_.empty() || exchange()) return;
  const int reason = errno;
  const bool is_unsupported = reason == EINVAL || reason == ENOSYS;
  is_new_ = reason == ENOENT;
  if (!is_new_ && !is_unsupported) fail("replace", reason);
  commit();
}

void AtomicFile::move_back() {
  if (is_new_)
    ::unlink(target_.c_str());
  else if (!temporary_.empty())
    exchange();
}

void AtomicFile::fail(const char* what, int reason) const {
  throw InputError(fmt::format(
      "{}: cannot {}: {}; give a path in a directory that exists, may be written and has space",
      target_, what, std::strerror(reason)));
}

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(std::size_t(count));
  }
  return 0;
}

void require_writable(const std::string& target) {
  // A pipe must not be opened twice: its reader would see an end. Directories are refused below.
  struct stat status {};
  const bool is_pipe_or_device =
      ::stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
  if (is_pipe_or_device && ::access(target.c_str(), W_OK) == 0) return;
  AtomicFile probe(target); // its destructor removes the temporary file, because nothing was
                            // committed
}

std::string read_text(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    throw InputError(fmt::format("{}: cannot read: {}", path, std::strerror(errno)));
  if (S_ISDIR(status.st_mode))
    throw InputError(fmt::format("{}: is a directory; give a file", path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot read: {}", path, std::strerror(errno)));
  return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace dss
