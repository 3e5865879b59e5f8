#pragma once
/// Checks cells against the state that the oracle computes.
#include "experiments/measure/cell_checks.hpp"
#include "experiments/measure/cell_study.hpp"

namespace dss {

/// Compares each cell with the oracle's state after a number of steps. Each state is saved once per
/// problem.
class OracleChecks : public CellChecks {
public:
  /// @param note  receives a line of text for each state that is computed
  OracleChecks(const CellStudy& study, const std::string& directory, bool keeps,
               std::function<void(const std::string&)> note)
      : study_(study), files_(directory, keeps), note_(std::move(note)) {}

  std::vector<std::string> options(const Cell& cell, long repetition) override;

private:
  void compute(const Cell& cell, const Scene& scene, const std::string& key,
               const std::string& path) const;

  const CellStudy& study_;
  KeyedFiles files_;
  std::function<void(const std::string&)> note_;
};

} // namespace dss
