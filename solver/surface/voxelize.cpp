#include "solver/surface/voxelize.hpp"

#include "solver/error.hpp"
#include "solver/memory.hpp"
#include "solver/parallel.hpp"
#include "solver/surface/winding_number.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

/// Part of a cell by which a surface may pass the grid: rounding of the file's single precision.
constexpr double rounding_slack = 1e-4;

[[noreturn]] void refuse_surface(const Surface& surface, const std::string& what) {
  throw InputError(fmt::format("surface {}: {}", surface.path, what));
}

std::string size_of(const Eigen::Vector3d& extent) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g} m", extent.x(), extent.y(), extent.z());
}

void require_closed(const Surface& surface) {
  constexpr const char* advice =
      "mend it, or give \"surface\": \"winding\", which fills it by winding numbers";
  if (const std::size_t edges = unpaired_edges(surface); edges > 0)
    refuse_surface(surface,
                   fmt::format("it is open, or shows both sides: {} of its edges do not join two "
                               "triangles in order; {}",
                               edges, advice));
}

VoxelGrid empty_voxels(const SpaceGrid& grid) {
  return {grid.count[0], grid.count[1], grid.count[2], std::vector<std::uint8_t>(grid.cells(), 0)};
}

std::size_t row_of(const SpaceGrid& grid, int y, int z) {
  return (std::size_t(z) * std::size_t(grid.count[1]) + std::size_t(y)) *
         std::size_t(grid.count[0]);
}

/// Fills the row of a closed surface. @return the winding number of a cell that is not 0 or 1, and
/// its x, if there is one
struct Overlap {
  int winding = 0, x = -1;
};
Overlap fill_row(const std::vector<Crossing>& line, const SpaceGrid& grid, double side,
                 std::uint8_t* row) {
  Overlap overlap;
  int winding = 0;
  auto next = line.begin();
  for (int x = 0; x < grid.count[0]; ++x) {
    for (; next != line.end() && next->at < grid.centre(0, x); ++next)
      winding += next->normal.x() * side < 0 ? 1 : -1;
    row[x] = winding == 1;
    if (winding != 0 && winding != 1 && overlap.x < 0) overlap = {winding, x};
  }
  return overlap;
}

VoxelGrid filled_by_crossings(const Surface& surface, const SpaceGrid& grid) {
  require_closed(surface);
  const double side = enclosed_volume(surface) < 0 ? -1 : 1;
  const Crossings crossings(surface, grid, 0);
  VoxelGrid voxels = empty_voxels(grid);
  for (int z = 0; z < grid.count[2]; ++z)
    for (int y = 0; y < grid.count[1]; ++y) {
      const Overlap overlap =
          fill_row(crossings.of_line(y, z), grid, side, &voxels.occupied[row_of(grid, y, z)]);
      if (overlap.x >= 0)
        refuse_surface(
            surface,
            fmt::format("it crosses itself, or parts overlap: winding number {} at [{:.4g}, "
                        "{:.4g}, {:.4g}] m; mend it, or give \"surface\": \"winding\", which "
                        "joins the parts",
                        overlap.winding, grid.centre(0, overlap.x), grid.centre(1, y),
                        grid.centre(2, z)));
    }
  return voxels;
}

/// Fills closed parts that may overlap.
VoxelGrid filled_by_spans(const Surface& surface, const SpaceGrid& grid) {
  const Crossings crossings(surface, grid, 0);
  VoxelGrid voxels = empty_voxels(grid);
  for (int z = 0; z < grid.count[2]; ++z)
    for (int y = 0; y < grid.count[1]; ++y) {
      std::uint8_t* const row = &voxels.occupied[row_of(grid, y, z)];
      for (const Span& span : spans(crossings.of_line(y, z), 0))
        for (int x = 0; x < grid.count[0]; ++x)
          if (grid.centre(0, x) > span.in.at && grid.centre(0, x) <= span.out.at) row[x] = 1;
    }
  return voxels;
}

/// Fills rows by winding numbers of an open surface. Between two crossings the number changes
/// smoothly, so it is found at three cells there, and at all if one of these is unclear.
class WindingFill {
public:
  WindingFill(const Surface& surface, const SpaceGrid& grid)
      : number_(surface), crossings_(surface, grid, 0), grid_(grid) {}
  void fill_row(int y, int z, std::uint8_t* row) {
    const std::vector<Crossing>& line = crossings_.of_line(y, z);
    int from = 0;
    for (std::size_t n = 0; n <= line.size(); ++n) {
      int to = from;
      while (to < grid_.count[0] && (n == line.size() || grid_.centre(0, to) < line[n].at)) ++to;
      if (to > from) fill_run(from, to, y, z, row);
      from = to;
    }
  }
  long inside() const { return inside_; }
  long unclear() const { return unclear_; }

private:
  double at(int x, int y, int z) const {
    return std::abs(number_.at({grid_.centre(0, x), grid_.centre(1, y), grid_.centre(2, z)}));
  }
  /// Cells [from, to) of a row, between two crossings.
  void fill_run(int from, int to, int y, int z, std::uint8_t* row) {
    constexpr double clear = 0.1; // distance from a whole number
    const double first = at(from, y, z), level = std::round(first);
    const auto is_clear = [&](double winding) { return std::abs(winding - level) < clear; };
    if (is_clear(first) && is_clear(at(to - 1, y, z)) && is_clear(at((from + to) / 2, y, z))) {
      std::fill(row + from, row + to, std::uint8_t(level >= 1));
      if (level >= 1) inside_ += to - from;
      return;
    }
    for (int x = from; x < to; ++x) {
      const double winding = at(x, y, z);
      row[x] = winding >= 0.5;
      inside_ += winding >= 0.5;
      unclear_ += winding > 0.25 && winding < 0.75;
    }
  }

  WindingNumber number_;
  Crossings crossings_;
  const SpaceGrid& grid_;
  std::atomic<long> inside_ = 0, unclear_ = 0;
};

VoxelGrid filled_by_winding(const Surface& surface, const SpaceGrid& grid) {
  if (unpaired_edges(surface) == 0) return filled_by_spans(surface, grid);
  VoxelGrid voxels = empty_voxels(grid);
  WindingFill fill(surface, grid);
  for_each_on_all_cores(std::size_t(grid.count[2]), [&](std::size_t z) {
    for (int y = 0; y < grid.count[1]; ++y)
      fill.fill_row(y, int(z), &voxels.occupied[row_of(grid, y, int(z))]);
  });
  if (double(fill.unclear()) > 0.01 * double(fill.inside()))
    refuse_surface(surface,
                   fmt::format("it does not enclose a body: {} cells have a winding number of 0.25 "
                               "to 0.75, {} cells one of 0.5 or more; close its holes",
                               fill.unclear(), fill.inside()));
  return voxels;
}

} // namespace

SurfaceRule surface_rule(const std::string& name) {
  if (name == "closed") return SurfaceRule::closed;
  if (name == "winding") return SurfaceRule::winding;
  throw InputError(
      fmt::format("\"{}\" is not a rule for surfaces; rules are closed, winding", name));
}

double edge_for(const Surface& surface, long count) {
  constexpr double longest_part = 100; // [m]
  const auto [low, high] = bounds(surface);
  const Eigen::Vector3d extent = high - low;
  if (extent.maxCoeff() > longest_part)
    refuse_surface(surface, fmt::format("it measures {}; check the unit, or give the size of an "
                                        "element in place of their number",
                                        size_of(extent)));
  return extent.maxCoeff() / double(count);
}

SpaceGrid grid_around(const Surface& surface, const Eigen::Vector3d& edge, long most_cells) {
  const auto [low, high] = bounds(surface);
  const Eigen::Vector3d extent = high - low;
  SpaceGrid grid;
  grid.edge = edge;
  double cells = 1;
  for (int a = 0; a < 3; ++a) {
    if (edge[a] > extent[a] * (1 + rounding_slack))
      refuse_surface(surface,
                     fmt::format("a cell of {:.4g} m is larger than the part along {}; it measures "
                                 "{}; check the unit, or take smaller cells",
                                 edge[a], "xyz"[a], size_of(extent)));
    const double count = std::ceil(extent[a] / edge[a] - rounding_slack);
    cells *= count;
    if (cells > double(most_cells))
      refuse_surface(surface,
                     fmt::format("it measures {}, which is more than {} cells of {:.4g} x {:.4g} x "
                                 "{:.4g} m; check the unit, or take larger cells",
                                 size_of(extent), most_cells, edge[0], edge[1], edge[2]));
    grid.count[std::size_t(a)] = int(count);
    grid.low[a] = (low[a] + high[a] - count * edge[a]) / 2;
  }
  return grid;
}

VoxelGrid filled(const Surface& surface, const SpaceGrid& grid, SurfaceRule rule) {
  // The grid and the lattice that is made from it take a byte each.
  require_memory(2 * double(grid.cells()),
                 fmt::format("surface {}: {} x {} x {} cells", surface.path, grid.count[0],
                             grid.count[1], grid.count[2]),
                 "take larger cells");
  VoxelGrid voxels = rule == SurfaceRule::closed ? filled_by_crossings(surface, grid)
                                                 : filled_by_winding(surface, grid);
  if (std::ranges::find(voxels.occupied, 1) == voxels.occupied.end())
    refuse_surface(surface,
                   fmt::format("it encloses no centre of {} x {} x {} cells; take smaller ones",
                               grid.count[0], grid.count[1], grid.count[2]));
  return voxels;
}

} // namespace dss
