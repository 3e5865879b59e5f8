#include "solver/io/file_set.hpp"

#include <algorithm>

namespace dss {

AtomicFile& FileSet::open(const std::string& target) {
  drop(target);
  files_.push_back(std::make_unique<AtomicFile>(target));
  return *files_.back();
}

void FileSet::drop(const std::string& target) {
  std::erase_if(files_, [&](const auto& file) { return file->target() == target; });
}

void FileSet::commit() {
  for (const auto& file : files_) file->finish();
  std::size_t moved = 0;
  try {
    for (; moved < files_.size(); ++moved) files_[moved]->move();
  } catch (...) {
    while (moved > 0) files_[--moved]->move_back();
    files_.clear();
    throw;
  }
  files_.clear();
}

} // namespace dss
