#pragma once
/// Cells of a study of work against precision: those of a block, each with several steps.
#include "experiments/runner/study.hpp"
#include "experiments/runner/study_reader.hpp"

#include <vector>

namespace dss {

/// Every cell with every step and every tolerance of adaptive steps that a block's key "accuracy" names. A step is shortened so that it divides the time between saved times;
/// steps that become the same are one.
/// @throws InputError with the place of what is wrong, also for a `dt` that does not divide it
std::vector<Cell> with_steps(const JsonPlace& accuracy, const std::vector<Cell>& cells, const Scale& scale);

/// Reads `end_time` [s] and `saved_times`; the scale may shorten the time. @throws InputError with the place
SavedTimes read_saved_times(const JsonPlace& place, double shorten);

} // namespace dss
