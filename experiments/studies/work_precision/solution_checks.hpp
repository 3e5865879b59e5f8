#pragma once
/// Cells compared with the solution of their scene at saved times.
#include "experiments/measure/cell_checks.hpp"
#include "experiments/studies/work_precision/precision_study.hpp"

namespace dss {

class SolutionChecks : public CellChecks {
public:
  /// @param note  is told what is computed
  SolutionChecks(const PrecisionStudy& study, const std::string& directory, bool keeps,
                 std::function<void(const std::string&)> note)
      : study_(study), files_(directory, keeps), note_(std::move(note)) {}

  std::vector<std::string> options(const Cell& cell, long repetition) override;
  bool is_instability_a_result() const override { return true; }

private:
  const PrecisionStudy& study_;
  KeyedFiles files_;
  std::function<void(const std::string&)> note_;
};

} // namespace dss
