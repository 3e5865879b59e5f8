#pragma once
/// Programs for a device: the shared physics, words for it, and the loops over rows of this folder's device/.
#include "kernels/physics.hpp"
#include "solver/model/model.hpp"

#include "kernels/stage_row/row.hpp"
#include <set>
#include <string>
#include <vector>

namespace dss::opencl {

/// What a program is for.
struct ProgramKind {
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  int lanes = 1;
  bool has_items = false;       ///< a work-item is a lane (GPUs), else a work-item goes along rows of packs (CPUs)
  std::set<row_action> actions; ///< what rows ask for: nothing else is compiled
  std::vector<Terms> terms;     ///< the combinations that rows name by their place here
};

/// Kernels run_passes and run_rows.
std::string row_program(const ProgramKind& kind);
/// Kernel evaluate_extra_links.
std::string extra_link_program(const ProgramKind& kind);

} // namespace dss::opencl
