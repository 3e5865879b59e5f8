#include "variants/engine/pass_order.hpp"

#include <algorithm>
#include <limits>

namespace dss {
namespace {

/// Rows of one body by their places: along the direction of the sweeps, and across it.
class BodyPlanes {
public:
  BodyPlanes(const Lattice& lattice, SweepRows rows, bool is_by_rows) {
    int least[2] = {std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
    int most[2] = {std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
    const auto each = [&](auto&& visit) {
      for (int r = rows.begin; r < rows.end; ++r)
        visit(r, lattice.rows[std::size_t(r)].y, lattice.rows[std::size_t(r)].z);
    };
    each([&](int, int y, int z) {
      least[0] = std::min(least[0], y), most[0] = std::max(most[0], y);
      least[1] = std::min(least[1], z), most[1] = std::max(most[1], z);
    });
    const int size_y = most[0] - least[0] + 1, size_z = most[1] - least[1] + 1;
    const bool is_along_y = is_by_rows ? size_z == 1 : size_y > size_z;
    along = is_along_y ? size_y : size_z;
    across = is_along_y ? size_z : size_y;
    rows_.assign(std::size_t(along) * std::size_t(across), -1);
    each([&](int r, int y, int z) {
      const int s = is_along_y ? y - least[0] : z - least[1],
                c = is_along_y ? z - least[1] : y - least[0];
      rows_[place(s, c)] = r;
    });
  }
  /// @return -1 if there is no such row
  int row(int s, int c) const {
    return s < 0 || s >= along || c < 0 || c >= across ? -1 : rows_[place(s, c)];
  }
  int along = 0, across = 0;

private:
  std::size_t place(int s, int c) const {
    return std::size_t(s) * std::size_t(across) + std::size_t(c);
  }
  std::vector<int> rows_;
};

/// Calls visit(rows) for the rows of each body.
template <class Visit>
void each_body(const Lattice& lattice, SweepRows all, Visit&& visit) {
  for (int begin = all.begin, end = begin; begin < all.end; begin = end) {
    const int body = lattice.rows[std::size_t(begin)].body;
    while (end < all.end && lattice.rows[std::size_t(end)].body == body) ++end;
    visit(SweepRows{begin, end});
  }
}

class Order {
public:
  Order(const Lattice& lattice, std::span<const SweepRows> sweeps, SweepForm form)
      : lattice_(lattice), sweeps_(sweeps), form_(form) {}
  void add_body(SweepRows rows) {
    const BodyPlanes planes(lattice_, rows, form_.is_by_rows);
    const int last = int(sweeps_.size()) - 1,
              tiles = form_.tile == no_tiles ? 1 : (planes.across + form_.tile - 1) / form_.tile;
    // The mean of the sweeps' edges divides the rows evenly.
    const auto edge = [&](int t) {
      return t == 0       ? 0
             : t == tiles ? planes.across + last
                          : (planes.across * t + tiles / 2) / tiles + last / 2;
    };
    for (int t = 0; t < tiles; ++t, ++tile_)
      for (int k = 0; k < planes.along + last; ++k)
        if (tiles == 1)
          add_plane(planes, k, 0, planes.across, 0);
        else
          add_plane(planes, k, edge(t), edge(t + 1), 1);
  }
  std::vector<PassTask> tasks;

private:
  /// Sweep n has the rows [begin - n skew, end - n skew) of plane k - n.
  void add_plane(const BodyPlanes& planes, int k, int begin, int end, int skew) {
    for (int c = begin; c < end; ++c)
      for (int n = 0; n < int(sweeps_.size()); ++n)
        if (const int r = planes.row(k - n, c - n * skew); r >= 0 && sweeps_[std::size_t(n)].has(r))
          add(n, r);
  }
  void add(int sweep, int row) {
    const Row& r = lattice_.rows[std::size_t(row)];
    const int begin = sweeps_[std::size_t(sweep)].begin;
    // Rows before the sweep's first leave no links by themselves.
    if (r.lower_y >= 0 && r.lower_y < begin) put(RowWork::upper_link_y, sweep, r.lower_y);
    if (r.lower_z >= 0 && r.lower_z < begin) put(RowWork::upper_link_z, sweep, r.lower_z);
    put(RowWork::stage, sweep, row);
  }
  void put(RowWork work, int sweep, int row) {
    tasks.push_back({work, std::int16_t(sweep), row, tile_});
  }

  const Lattice& lattice_;
  const std::span<const SweepRows> sweeps_;
  const SweepForm form_;
  int tile_ = 0;
};

} // namespace

std::vector<PassTask> order_pass(const Lattice& lattice, std::span<const SweepRows> sweeps,
                                 SweepForm form) {
  Order order(lattice, sweeps, form);
  each_body(lattice, sweeps.front(), [&](SweepRows rows) { order.add_body(rows); });
  return std::move(order.tasks);
}

int most_rows_across(const Lattice& lattice, SweepRows rows, bool is_by_rows) {
  int most = 0;
  each_body(lattice, rows, [&](SweepRows body) {
    most = std::max(most, BodyPlanes(lattice, body, is_by_rows).across);
  });
  return most;
}

} // namespace dss
