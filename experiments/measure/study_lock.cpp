#include "experiments/measure/study_lock.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/io/temporaries.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dss {
namespace {

/// True if a descriptor is still the file of this name: another process may have removed it.
bool is_file_of(int descriptor, const std::string& path) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

[[noreturn]] void refuse(const std::string& path, int descriptor) {
  char bytes[200] = {};
  const ssize_t count = ::read(descriptor, bytes, sizeof bytes - 1);
  ::close(descriptor);
  std::string holder(bytes, std::size_t(std::max<ssize_t>(count, 0)));
  if (holder.empty()) holder = "another process";
  throw InputError(fmt::format("{}: {} measures this study here; wait for its end, or give "
                               "another --out",
                               path, holder.substr(0, holder.find('\n'))));
}

} // namespace

StudyLock::StudyLock(const std::string& path) : path_(path + ".lock") {
  for (;;) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0)
      throw InputError(fmt::format("{}: cannot lock: {}", path_, std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) {
      if (is_file_of(descriptor_, path_)) break;
      ::close(descriptor_);
      continue;
    }
    const int reason = errno;
    if (reason == EWOULDBLOCK) refuse(path, descriptor_);
    // Some file systems of clusters have no locks. Studies there are measured without.
    ::unlink(path_.c_str());
    return;
  }
  remember_temporary(path_);
  const std::string text = fmt::format("process {}, since {},\n", ::getpid(), measurement_time());
  // Only for messages: the lock holds without it.
  if (::ftruncate(descriptor_, 0) == 0) write_all(descriptor_, text);
}

StudyLock::~StudyLock() {
  forget_temporary(path_); // first: after the removal the name may be another process's
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

} // namespace dss
