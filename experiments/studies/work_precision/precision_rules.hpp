#pragma once
/// What a study of work against precision asks for besides its cells (experiments/README.md
/// describes the JSON).
#include "experiments/measure/solution_rule.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// The cells of one line of a chart.
struct Contender {
  std::string integrator, precision;
  double dt = 0; ///< [s]; 0: any step, the cheapest that is accurate enough
};

/// "How many times cheaper than `base` is `contender`, as accurate as the space discretisation of
/// the scene?"
struct CostComparison {
  std::string scene,
      space; ///< the scene of the cells; the label of the error budget whose error in space counts
  Contender contender, base;
};

struct PrecisionRules {
  SolutionRule solution;
  std::vector<double> tolerances; ///< for each the cheapest cell is sought, descending
  std::vector<CostComparison> comparisons;
};

/// Reads a study's key "work_precision". @throws InputError with the place of what is wrong
PrecisionRules read_precision_rules(const Node& node);

} // namespace dss
