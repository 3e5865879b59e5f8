#pragma once
/// Interface for checking the results of a study's cells.
#include "experiments/measure/cell.hpp"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace dss {

/// Supplies the reference that each repetition of a cell is compared with.
class CellChecks {
public:
  virtual ~CellChecks() = default;
  /// Options of `dssbench run` that name the reference of a repetition. Computes the reference
  /// first if it does not exist yet.
  /// @throws InputError, UnstableError if the reference cannot be computed
  virtual std::vector<std::string> options(const Cell& cell, long repetition) = 0;
  /// True if an unstable run (with non-finite numbers) is a valid result, as in a study of methods.
  virtual bool is_instability_a_result() const { return false; }
};

/// Files in a directory, one for each key. Each file is made at most once.
class KeyedFiles {
public:
  /// @param keeps  true: reuse files of an earlier run of the study if they have the same key
  KeyedFiles(std::string directory, bool keeps) : directory_(std::move(directory)), keeps_(keeps) {}

  /// Path of the file of a key; makes the file if needed.
  /// @param key_in  reads the key of an existing file
  /// @param make  writes the file
  std::string file_of(const std::string& key, const std::string& extension,
                      const std::function<std::string(const std::string& path)>& key_in,
                      const std::function<void(const std::string& path)>& make);

private:
  std::string directory_;
  bool keeps_;
  std::set<std::string> made_; ///< paths already checked or made
};

} // namespace dss
