#pragma once
/// Files of one run, which are new or old together.
#include "solver/io/atomic_file.hpp"

#include <memory>
#include <string>
#include <vector>

namespace dss {

/// Files under construction. commit() moves all of them to their targets. Without it, or if it
/// fails, earlier files stay unchanged.
///
/// Files move one after another. A process that is killed between two moves, or a loss of power
/// there, leaves some of them new.
class FileSet {
public:
  /// Begins a file, in place of an earlier one of this target. It lives as long as the set, or
  /// until it is dropped.
  /// @throws InputError as AtomicFile
  AtomicFile& open(const std::string& target);
  /// Gives up the file of this target, if there is one.
  void drop(const std::string& target);
  /// Moves all files to their targets. The set is empty afterwards.
  /// @throws InputError if one cannot be moved; those before it are moved back, and the new files
  ///     are lost
  void commit();

private:
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

} // namespace dss
