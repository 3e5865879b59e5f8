#pragma once
/// Cells of a study of work against precision: those of a block, each with several steps.
#include "experiments/studies/work_precision/precision_study.hpp"
#include "solver/json/node.hpp"

#include <vector>

namespace dss {

/// Reads "halvings" of a block or a scale: whole numbers, which may be negative.
std::vector<int> read_halvings(const Node& node);

/// Every cell with every step and every tolerance of adaptive steps that a block's key "accuracy"
/// names; what they are compared with goes to `study`. A step is shortened so that it divides the
/// time between saved times; steps that become the same are one.
/// @throws InputError with the place of what is wrong, also for a `dt` that does not divide it
std::vector<Cell> with_steps(const Node& accuracy, const std::vector<Cell>& cells,
                             PrecisionStudy& study);

} // namespace dss
