/// Blocks: recursive bisection in the coordinates of the bodies' rest positions.
#include "solver/decomposition/methods.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace dss {
namespace {

/// Cells of a body between planes: low <= index < high on each axis.
struct Bounds {
  std::array<int, 3> low{}, high{};
  bool is_empty() const { return low[0] >= high[0]; }
};

/// All cells whose centres share one coordinate.
struct Plane {
  double position = 0; ///< [m]
  double cost = 0;
  std::size_t cells = 0;
};

struct Cut {
  std::size_t axis = 0;
  double position = 0; ///< between two planes [m]
};

class Bisection {
public:
  explicit Bisection(const Division& division) : division_(division) {}

  /// Divides a set of present cells among the parts first .. first + parts - 1.
  void divide(const CellSet& set, int first, int parts);
  std::vector<Share> shares;

private:
  double centre(std::size_t body, std::size_t axis, int index) const {
    const Body& b = division_.problem.bodies[body];
    return b.origin[axis] + b.edge[axis] * (index + 0.5);
  }
  std::size_t body_of(const Segment& segment) const {
    return std::size_t(division_.grid.row(segment.row).body);
  }
  double cost_of(const Segment& segment) const { return division_.body_cost[body_of(segment)]; }
  std::vector<Bounds> bounds_of(const CellSet& set) const;
  std::array<double, 3> extents(const std::vector<Bounds>& bounds) const;
  std::vector<Plane> planes(const CellSet& set, const std::vector<Bounds>& bounds,
                            std::size_t axis) const;
  std::optional<Cut> choose_cut(const CellSet& set, int parts, double fraction) const;
  std::pair<CellSet, CellSet> split(const CellSet& set, const Cut& cut) const;
  std::pair<CellSet, CellSet> split_in_order(const CellSet& set, int parts, double fraction) const;

  const Division& division_;
};

std::vector<Bounds> Bisection::bounds_of(const CellSet& set) const {
  constexpr int far = std::numeric_limits<int>::max();
  std::vector<Bounds> bounds(division_.problem.bodies.size(),
                             Bounds{{far, far, far}, {-far, -far, -far}});
  for (const Segment& segment : set.segments()) {
    const Row& row = division_.grid.row(segment.row);
    Bounds& b = bounds[std::size_t(row.body)];
    const std::array<int, 3> low = {segment.x_begin, row.y, row.z},
                             high = {segment.x_end, row.y + 1, row.z + 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.low[axis] = std::min(b.low[axis], low[axis]);
      b.high[axis] = std::max(b.high[axis], high[axis]);
    }
  }
  return bounds;
}

std::array<double, 3> Bisection::extents(const std::vector<Bounds>& bounds) const {
  std::array<double, 3> extent{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::max(), high = -low;
    for (std::size_t body = 0; body < bounds.size(); ++body) {
      if (bounds[body].is_empty()) continue;
      const double half_edge = division_.problem.bodies[body].edge[axis] / 2;
      low = std::min(low, centre(body, axis, bounds[body].low[axis]) - half_edge);
      high = std::max(high, centre(body, axis, bounds[body].high[axis] - 1) + half_edge);
    }
    extent[axis] = high - low;
  }
  return extent;
}

// Counts cells along x from the ends of segments: +1 where a segment begins, -1 where it ends.
std::vector<Plane> Bisection::planes(const CellSet& set, const std::vector<Bounds>& bounds,
                                     std::size_t axis) const {
  std::vector<std::vector<std::ptrdiff_t>> cells(bounds.size());
  for (std::size_t body = 0; body < bounds.size(); ++body)
    if (!bounds[body].is_empty())
      cells[body].resize(std::size_t(bounds[body].high[axis] - bounds[body].low[axis]) + 1);
  for (const Segment& segment : set.segments()) {
    const Row& row = division_.grid.row(segment.row);
    std::vector<std::ptrdiff_t>& count = cells[std::size_t(row.body)];
    const int low = bounds[std::size_t(row.body)].low[axis];
    if (axis == 0) {
      ++count[std::size_t(segment.x_begin - low)];
      --count[std::size_t(segment.x_end - low)];
    } else {
      count[std::size_t((axis == 1 ? row.y : row.z) - low)] += segment.x_end - segment.x_begin;
    }
  }
  std::vector<Plane> all;
  for (std::size_t body = 0; body < bounds.size(); ++body) {
    if (axis == 0) std::partial_sum(cells[body].begin(), cells[body].end(), cells[body].begin());
    for (std::size_t k = 0; k < cells[body].size(); ++k)
      if (cells[body][k] > 0)
        all.push_back({centre(body, axis, bounds[body].low[axis] + int(k)),
                       double(cells[body][k]) * division_.body_cost[body],
                       std::size_t(cells[body][k])});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Plane& a, const Plane& b) { return a.position < b.position; });
  return all;
}

/// Cut between planes that is nearest to the wanted fraction of the cost and leaves enough cells on
/// each side. Axes are tried from the longest extent on. Among equal extents the later axis comes
/// first, so that rows stay whole.
std::optional<Cut> Bisection::choose_cut(const CellSet& set, int parts, double fraction) const {
  const std::vector<Bounds> bounds = bounds_of(set);
  const std::array<double, 3> extent = extents(bounds);
  std::array<std::size_t, 3> axes = {2, 1, 0};
  std::stable_sort(axes.begin(), axes.end(), [&](std::size_t a, std::size_t b) {
    return extent[a] > extent[b] * (1 + 1e-9);
  });
  const auto least_left = std::size_t(parts / 2), least_right = std::size_t(parts - parts / 2);
  for (const std::size_t axis : axes) {
    const std::vector<Plane> all = planes(set, bounds, axis);
    double cost = 0, left_cost = 0, nearest = std::numeric_limits<double>::max();
    std::size_t cells = set.cell_count(), left_cells = 0;
    for (const Plane& plane : all) cost += plane.cost;
    std::optional<Cut> best;
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
      left_cost += all[k].cost;
      left_cells += all[k].cells;
      const double gap = all[k + 1].position - all[k].position;
      // These are one plane of two bodies, except for rounding.
      if (gap < 1e-6 * extent[axis] / double(all.size())) continue;
      if (left_cells < least_left || cells - left_cells < least_right) continue;
      const double miss = std::abs(left_cost - fraction * cost);
      if (miss >= nearest) continue;
      nearest = miss;
      best = Cut{axis, all[k].position + gap / 2};
    }
    if (best) return best;
  }
  return {};
}

std::pair<CellSet, CellSet> Bisection::split(const CellSet& set, const Cut& cut) const {
  const std::size_t bodies = division_.problem.bodies.size();
  const std::vector<Bounds> bounds = bounds_of(set);
  // Index of each body's first plane beyond the cut.
  std::vector<int> first_right(bodies);
  for (std::size_t body = 0; body < bodies; ++body) {
    int low = bounds[body].low[cut.axis], high = bounds[body].high[cut.axis];
    while (low < high) {
      const int middle = low + (high - low) / 2;
      (centre(body, cut.axis, middle) < cut.position ? low : high) =
          centre(body, cut.axis, middle) < cut.position ? middle + 1 : middle;
    }
    first_right[body] = low;
  }
  std::pair<CellSet, CellSet> sides;
  for (const Segment& segment : set.segments()) {
    const Row& row = division_.grid.row(segment.row);
    const int border = first_right[std::size_t(row.body)];
    if (cut.axis == 0) {
      sides.first.append({segment.row, segment.x_begin, std::min(segment.x_end, border)});
      sides.second.append({segment.row, std::max(segment.x_begin, border), segment.x_end});
    } else {
      ((cut.axis == 1 ? row.y : row.z) < border ? sides.first : sides.second).append(segment);
    }
  }
  return sides;
}

/// Splits the cells in the lattice's order, at any place. Used if no plane leaves a cell for every
/// part.
std::pair<CellSet, CellSet> Bisection::split_in_order(const CellSet& set, int parts,
                                                      double fraction) const {
  double cost = 0;
  for (const Segment& segment : set.segments())
    cost += cost_of(segment) * (segment.x_end - segment.x_begin);
  double wanted = fraction * cost;
  std::size_t left = 0;
  for (const Segment& segment : set.segments()) {
    const double cells = std::clamp(std::round(wanted / cost_of(segment)), 0.0,
                                    double(segment.x_end - segment.x_begin));
    left += std::size_t(cells);
    wanted -= double(segment.x_end - segment.x_begin) * cost_of(segment);
  }
  left =
      std::clamp(left, std::size_t(parts / 2), set.cell_count() - std::size_t(parts - parts / 2));
  std::pair<CellSet, CellSet> sides;
  for (const Segment& segment : set.segments()) {
    const int here = int(std::min(left, std::size_t(segment.x_end - segment.x_begin)));
    sides.first.append({segment.row, segment.x_begin, segment.x_begin + here});
    sides.second.append({segment.row, segment.x_begin + here, segment.x_end});
    left -= std::size_t(here);
  }
  return sides;
}

void Bisection::divide(const CellSet& set, int first, int parts) {
  if (parts == 1) {
    for (const Segment& segment : set.segments()) shares.push_back({segment, first});
    return;
  }
  const auto begin = division_.speed.begin() + first;
  const double left_speed = std::accumulate(begin, begin + parts / 2, 0.0);
  const double fraction = left_speed / std::accumulate(begin, begin + parts, 0.0);
  const std::optional<Cut> cut = choose_cut(set, parts, fraction);
  const auto [left, right] = cut ? split(set, *cut) : split_in_order(set, parts, fraction);
  divide(left, first, parts / 2);
  divide(right, first + parts / 2, parts - parts / 2);
}

} // namespace

std::vector<Share> divide_in_blocks(const Division& division) {
  Bisection bisection(division);
  bisection.divide(division.grid.all(), 0, division.parts());
  return std::move(bisection.shares);
}

} // namespace dss
