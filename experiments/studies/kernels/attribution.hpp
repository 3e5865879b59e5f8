#pragma once
/// Where the time of a step goes: its row kernels by themselves, beside what the processor gives
/// for their arithmetic, their mix of instructions and their traffic, all timed in turn, since the
/// clock of a shared machine changes from second to second.
#include "experiments/measure/ceilings/ceilings.hpp"
#include "kernels/model.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

struct AttributionCase {
  std::string variant;
  Model model;
  Precision precision;
  int n; ///< elements a side of plate_paper
};

/// Rows of tables/attribution.csv for one case: stage_row (three a step), stage_row_last (one), the
/// rest, and the step. Times are medians over the rounds, in ns of an element and step; shares are
/// medians of ratios within a round; columns NAME_low and NAME_high are their 95 % intervals.
/// @param raw  gets the times of all rounds, an element of `peak` being a flop
/// @throws InputError if the variant has no kernels or cannot run here
std::vector<Record> attribute_step(const AttributionCase& one, int rounds, double sample_s,
                                   const std::vector<Ceiling>& ceilings, RecordFile& raw);

const std::vector<std::string>& attribution_columns();
const std::vector<std::string>& attribution_raw_columns();

} // namespace dss
