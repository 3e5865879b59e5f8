#pragma once
/// Samples of a study's cells, and which of them may be compared.
#include "experiments/base/statistics.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/samples.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dss {

/// Records of the study's scale only; a resumed file may hold records of other scales.
std::vector<Record> records_of_scale(const CellStudy& study, const std::vector<Record>& records);

/// Finds the sample of a cell and computes speed-ups between cells.
class StudySamples {
public:
  /// @param records  records of the study's scale
  StudySamples(const CellStudy& study, const std::vector<Record>& records);

  /// Null if nothing is recorded for the cell.
  const CellSample* of(const Cell& cell) const;
  /// True if the final states differ within the group of cells that must have the same bits.
  bool is_unequal(const Cell& cell) const;
  /// Speed-up of `cell` over `base`: the ratio of their times per step in the same round, with its
  /// interval. Empty if either cell is not measured, failed, wrong or oversubscribed.
  std::optional<Estimate> speedup(const Cell& base, const Cell& cell) const;

private:
  bool is_comparable(const Cell& cell) const;

  std::vector<CellSample> samples_;
  std::map<std::string, const CellSample*> by_key_;
  std::set<std::string> unequal_; ///< groups of cells that must have the same bits but do not
};

} // namespace dss
