#pragma once
/// Reads one block of a study's JSON: a block stands for every combination of the values that it
/// lists.
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_sets.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// Rules that a kind of study sets for its cells.
struct CellRules {
  int cores = 1; ///< value of the word "cores" in the JSON
  /// Further keys that this kind allows in a block and in a scale.
  std::vector<std::string> block_keys, scale_keys;
  /// Makes more cells, with steps of their own, from those of a block. If empty, each cell has the
  /// steps of the scale.
  std::function<std::vector<Cell>(ObjectNode& block, const std::vector<Cell>& cells)> expand;
};

/// What a block needs of a study's scales.
struct StudyScales {
  std::vector<std::string> names; ///< of all of them
  Sets sets;                      ///< overrides of the one that is measured
};

/// Adds the cells of a block to `study`, unless the block leaves out the scale `study.scale`, which
/// must be set. A cell that an earlier block has added is not added again. Loads every scene with
/// its overrides.
/// @throws InputError with the place of the mistake
void add_block(const Node& place, const StudyScales& scales, const CellRules& rules,
               CellStudy& study);

} // namespace dss
