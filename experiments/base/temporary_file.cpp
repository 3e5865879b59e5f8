#include "experiments/base/temporary_file.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/io/temporaries.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace dss {
namespace {

/// Writes the text, and closes the file. @return 0, or the reason
int write_and_close(int descriptor, const std::string& text) {
  const int reason = write_all(descriptor, text);
  return ::close(descriptor) == 0 || reason != 0 ? reason : errno;
}

} // namespace

TemporaryFile::TemporaryFile(const std::string& text, const std::string& suffix) {
  std::error_code error; // then the directory does not exist, and making the file says so
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  path_ = ((error ? "/tmp" : folder) / ("dssbench-XXXXXX" + suffix)).string();
  const int descriptor = make_temporary(path_, 0600);
  const int reason = descriptor < 0 ? errno : write_and_close(descriptor, text);
  if (reason == 0) return;
  if (descriptor >= 0) {
    ::unlink(path_.c_str());
    forget_temporary(path_);
  }
  throw InputError(fmt::format("{}: cannot write a temporary file: {}; set TMPDIR to a directory "
                               "that may be written and has space",
                               path_, std::strerror(reason)));
}

TemporaryFile::~TemporaryFile() {
  ::unlink(path_.c_str());
  forget_temporary(path_);
}

} // namespace dss
