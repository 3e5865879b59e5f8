#pragma once
/// One writer for the records of a study.
#include <string>

namespace dss {

/// Holds the records of a study for this process. The system gives the lock back when the process
/// ends, however it ends. Where the file system has no locks, nothing is held.
class StudyLock {
public:
  /// @param path  PATH.lock is made beside the records
  /// @throws InputError if another process has it: which one, and since when
  explicit StudyLock(const std::string& path);
  StudyLock(const StudyLock&) = delete;
  StudyLock& operator=(const StudyLock&) = delete;
  ~StudyLock();

private:
  std::string path_;
  int descriptor_ = -1;
};

} // namespace dss
