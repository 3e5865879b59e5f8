#include "variants/opencl/stage_tile.hpp"

#include "solver/error.hpp"
#include "variants/opencl/device.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <string_view>

namespace dss::opencl {
namespace {

std::size_t work_items(const StageTile& tile) {
  return std::size_t(tile.width) * std::size_t(tile.height);
}

std::size_t most_work_items(const Device& device) {
  return guarded(device.entry.name,
                 [&] { return device.handle.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(); });
}

StageTile asked_tile(std::string_view text, int stages, std::size_t most) {
  StageTile tile;
  if (text == "0") return tile;
  int end = 0;
  const int numbers =
      std::sscanf(text.data(), "%4dx%4dx%4d%n", &tile.width, &tile.height, &tile.stages, &end);
  tile.stages = std::min(tile.stages, stages);
  if (numbers != 3 || std::size_t(end) != text.size() || tile.stages < 1 || tile.across() < 1 ||
      tile.rows() < 1 || work_items(tile) > most)
    throw InputError(fmt::format(
        "DSSBENCH_STAGE_TILE={}: no tile; give WIDTHxHEIGHTxSTAGES such as 16x16x4, with at most "
        "{} work-items, and a tile left between halos of a layer for each stage but the last, or 0 "
        "for none",
        text, most));
  return tile;
}

/// The same, with launches of about as many stages each. A layer of halo less is less work.
StageTile balanced(StageTile tile, int stages) {
  const int launches = (stages + tile.stages - 1) / tile.stages;
  tile.stages = (stages + launches - 1) / launches;
  return tile;
}

} // namespace

StageTile choose_stage_tile(int elements_across, int rows, int stages, Precision precision,
                            const Device& device) {
  const std::size_t most = most_work_items(device);
  if (const char* const asked = std::getenv("DSSBENCH_STAGE_TILE"))
    return asked_tile(asked, stages, most);
  StageTile tile;
  for (const StageTile& next : {StageTile{16, 16, 4}, StageTile{32, 8, 2}, StageTile{32, 16, 2}}) {
    if (work_items(next) > most) break;
    tile = balanced(next, stages);
    if (tile.groups_across(elements_across) * tile.groups_along(rows) <= device.compute_units)
      return tile;
  }
  const bool is_filled = tile.is_used() && elements_across >= tile.across() && rows >= tile.rows();
  return is_filled && precision == Precision::f64 ? tile : StageTile{};
}

std::string stages_text(const StageTile& tile) {
  if (!tile.is_used()) return "stage by stage";
  return fmt::format("{} stage{} a launch, in tiles of {} x {} elements", tile.stages,
                     tile.stages == 1 ? "" : "s", tile.across(), tile.rows());
}

} // namespace dss::opencl
