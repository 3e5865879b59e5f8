#pragma once
/// Several stages of a GPU in one launch.
#include "kernels/precision.hpp"

#include <string>

namespace dss::opencl {

struct Device;

/// What a work-group of a GPU computes in one launch: some stages of a tile of elements. Its
/// work-items also compute the halo of the tile, which has a layer for each stage but the last.
struct StageTile {
  int width = 0, height = 0; ///< work-items across and along the rows; 0: a launch is one stage
  int stages = 1;            ///< of a launch

  bool is_used() const { return width > 0; }
  int halo() const { return stages - 1; }
  /// Elements of the tile without its halo.
  int across() const { return width - 2 * halo(); }
  int rows() const { return height - 2 * halo(); }
  /// Groups for a number of elements across, or of rows.
  int groups_across(int elements) const { return (elements + across() - 1) / across(); }
  int groups_along(int count) const { return (count + rows() - 1) / rows(); }
};

/// The tile for a problem whose rows need only the rows next to them (README.md, "Several stages a
/// launch"). If DSSBENCH_STAGE_TILE is set, it decides: WIDTHxHEIGHTxSTAGES, or 0 for none.
/// @param elements_across  of the widest body, in whole packs
/// @param rows             of all bodies
/// @param stages           of the method
/// @throws InputError if the variable is not of that form, or the device's groups are smaller
StageTile choose_stage_tile(int elements_across, int rows, int stages, Precision precision,
                            const Device& device);

/// How many stages a launch has, for the schedule of a record.
std::string stages_text(const StageTile& tile);

} // namespace dss::opencl
