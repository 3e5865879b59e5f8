#pragma once
/// What was measured of a study's cells, and which of it may be compared.
#include "experiments/runner/samples.hpp"
#include "experiments/runner/statistics.hpp"
#include "experiments/runner/study.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dss {

/// Those of the study's scale; a resumed file may hold others.
std::vector<Record> records_of_scale(const Study& study, const std::vector<Record>& records);

class StudySamples {
public:
  /// @param records  of the study's scale
  StudySamples(const Study& study, const std::vector<Record>& records);

  /// Null if nothing is recorded of the cell.
  const CellSample* of(const Cell& cell) const;
  /// Its bits, or those of cells that must agree with it, differ.
  bool is_unequal(const Cell& cell) const;
  /// How many times faster a step of `cell` is than one of `base`, by pairs of the same round; nothing if a time of
  /// either counts for nothing: not measured, failed, wrong, oversubscribed.
  std::optional<Estimate> speedup(const Cell& base, const Cell& cell) const;

private:
  bool is_comparable(const Cell& cell) const;

  std::vector<CellSample> samples_;
  std::map<std::string, const CellSample*> by_key_;
  std::set<std::string> unequal_; ///< groups of cells that must agree to the last bit, and do not
};

} // namespace dss
