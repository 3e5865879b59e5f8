#pragma once
/// Files of what the runs of a study are compared with: the oracle's state after some steps, or the scene's solution.
#include "experiments/runner/study.hpp"

#include <functional>
#include <set>
#include <string>

namespace dss {

class ExpectedFiles {
public:
  /// @param keeps  files of an earlier run of the study serve if they say that they are of the same
  /// @param note   is told what is computed
  ExpectedFiles(const Study& study, std::string directory, bool keeps, std::function<void(const std::string&)> note)
      : study_(study), directory_(std::move(directory)), keeps_(keeps), note_(std::move(note)) {}

  /// File for a cell; computed once a study. @throws InputError, UnstableError if it cannot be
  std::string file_of(const Cell& cell);

private:
  void make_oracle_state(const Cell& cell, const Scene& scene, const std::string& key, const std::string& path) const;
  void make_solution(const Cell& cell, const Scene& scene, const std::string& key, const std::string& path) const;

  const Study& study_;
  std::string directory_;
  bool keeps_;
  std::function<void(const std::string&)> note_;
  std::set<std::string> made_; ///< paths
};

} // namespace dss
