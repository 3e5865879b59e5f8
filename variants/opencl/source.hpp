#pragma once
/// The text of programs for a device: the shared physics, definitions of its words (REAL, FMA,
/// LOAD, ...), and the loops over rows in device/.
#include "kernels/model.hpp"
#include "kernels/physics.hpp"

#include "kernels/stage_row/row.hpp"
#include "variants/opencl/stage_tile.hpp"
#include <set>
#include <string>
#include <vector>

namespace dss::opencl {

/// What a program is for.
struct ProgramKind {
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  int lanes = 1;
  /// true (GPUs): a work-item computes a lane. false (CPUs): a work-item goes along rows of packs.
  bool has_items = false;
  std::set<row_action> actions; ///< the actions that rows need; others are not compiled
  std::vector<Terms> terms;     ///< the combinations that rows refer to by index
  StageTile tile;               ///< of a GPU
  bool has_link_kinds = false;  ///< the links of a body differ
};

/// Text of a program with the kernel run_tiles if it has a tile, else with run_passes and run_rows.
std::string row_program(const ProgramKind& kind);
/// Text of a program with the kernel evaluate_extra_links.
std::string extra_link_program(const ProgramKind& kind);

} // namespace dss::opencl
