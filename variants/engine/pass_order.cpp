#include "variants/engine/pass_order.hpp"

#include <algorithm>
#include <utility>

namespace dss {
namespace {

/// From the first row of any sweep to behind the last one.
SweepRows all_rows(std::span<const SweepRows> sweeps) {
  SweepRows all = sweeps.front();
  for (const SweepRows& rows : sweeps)
    all = {std::min(all.begin, rows.begin), std::max(all.end, rows.end)};
  return all;
}

/// Which extra links a row has, and which of them a sweep has computed already.
class ExtraWork {
public:
  ExtraWork(std::span<const LinkedRows> extra, std::size_t rows, std::size_t sweeps)
      : computed_(sweeps, std::vector<std::uint8_t>(extra.size())) {
    if (extra.empty()) return;
    links_of_.resize(rows);
    for (std::size_t n = 0; n < extra.size(); ++n)
      for (const int row : {extra[n].i, extra[n].j}) add(links_of_[std::size_t(row)], int(n));
  }
  std::span<const int> links_of(int row) const {
    if (links_of_.empty()) return {};
    return links_of_[std::size_t(row)];
  }
  /// @return whether this is the first time that the sweep asks for the link
  bool begin(int sweep, int link) {
    std::uint8_t& is_computed = computed_[std::size_t(sweep)][std::size_t(link)];
    return std::exchange(is_computed, 1) == 0;
  }

private:
  static void add(std::vector<int>& links, int link) {
    if (links.empty() || links.back() != link) links.push_back(link); // both ends in one row
  }
  std::vector<std::vector<int>> links_of_;          ///< empty if there are no extra links
  std::vector<std::vector<std::uint8_t>> computed_; ///< [sweep][link]
};

class Order {
public:
  Order(const Lattice& lattice, const RowOrder& rows, std::span<const SweepRows> sweeps,
        SweepForm form, std::span<const LinkedRows> extra, StepSweeps of_step)
      : lattice_(lattice), rows_(rows), sweeps_(sweeps), form_(form), of_step_(of_step),
        extra_(extra, lattice.rows.size(), sweeps.size()) {}
  void add_group(const BodyGroup& group) {
    const BodyPlanes& planes = group.members().front().planes;
    // Tiles of cut rows begin where the rows were cut for them, others divide the rows evenly.
    const bool is_cut = !lattice_.cuts.empty() && form_.tile != no_tiles;
    // Pieces of the first tile that the body does not have.
    const int without = is_cut ? planes.first_piece % form_.tile : 0;
    const int last = int(sweeps_.size()) - 1, across = planes.across,
              tiles = form_.tile == no_tiles || group.is_linked()
                          ? 1
                          : (across + without + form_.tile - 1) / form_.tile;
    // The mean of the sweeps' edges divides the rows evenly.
    const auto edge = [&](long t) {
      return t == 0       ? 0
             : t == tiles ? across + last
             : is_cut     ? int(t) * form_.tile - without
                          : int((across * t + tiles / 2) / tiles) + last / 2;
    };
    for (int t = 0; t < tiles; ++t, ++tile_)
      for (int k = 0; k < group.planes() + last * group.lag(); ++k)
        for (const BodyGroup::Member& member : group.members()) {
          const int first = k - member.shift; // plane of the first sweep
          if (first < 0 || first >= member.planes.along + last * group.lag()) continue;
          if (!has_rows(member.planes, first, group.lag())) continue;
          if (tiles == 1)
            add_plane(member.planes, first, group.lag(), 0, member.planes.across, 0);
          else
            add_plane(member.planes, first, 1, edge(t), edge(t + 1), 1);
        }
  }
  std::vector<PassTask> tasks;

private:
  /// Whether a sweep has rows of its plane: a block has those of a part of the planes.
  bool has_rows(const BodyPlanes& planes, int first, int lag) const {
    for (int n = 0; n < int(sweeps_.size()); ++n) {
      // Places ascend across a plane.
      const int k = first - n * lag;
      int low = 0, high = planes.across - 1;
      while (low <= high && planes.row(k, low) < 0) ++low;
      while (low <= high && planes.row(k, high) < 0) --high;
      const SweepRows& rows = sweeps_[std::size_t(n)];
      if (low <= high && rows_.place(planes.row(k, low)) < rows.end &&
          rows_.place(planes.row(k, high)) >= rows.begin)
        return true;
    }
    return false;
  }
  /// Sweep n has the rows [begin, end - n skew) of plane k - n lag, each n skew lower.
  void add_plane(const BodyPlanes& planes, int k, int lag, int begin, int end, int skew) {
    for (int c = begin; c < end; ++c)
      for (int n = 0; n < int(sweeps_.size()); ++n)
        if (const int r = planes.row(k - n * lag, c - n * skew);
            r >= 0 && sweeps_[std::size_t(n)].has(rows_.place(r)))
          add(n, r);
  }
  void add(int sweep, int row) {
    const Row& r = lattice_.rows[std::size_t(row)];
    const int begin = sweeps_[std::size_t(sweep)].begin;
    // Rows before the sweep's first leave no links by themselves.
    const auto is_before = [&](int lower) { return lower >= 0 && rows_.place(lower) < begin; };
    if (is_before(r.lower_x)) put(RowWork::upper_link_x, sweep, r.lower_x);
    if (is_before(r.lower_y)) put(RowWork::upper_link_y, sweep, r.lower_y);
    if (is_before(r.lower_z)) put(RowWork::upper_link_z, sweep, r.lower_z);
    if (of_step_.is_pressure(sweep)) return put(RowWork::pressure, sweep, row);
    const std::span<const int> links = extra_.links_of(row);
    for (const int link : links)
      if (extra_.begin(sweep, link)) put(RowWork::extra_link, sweep, link);
    if (!links.empty()) put(RowWork::extra_sum, sweep, row);
    put(RowWork::stage, sweep, row);
  }
  void put(RowWork work, int sweep, int row) {
    tasks.push_back({work, std::int16_t(sweep), row, tile_});
  }

  const Lattice& lattice_;
  const RowOrder& rows_;
  const std::span<const SweepRows> sweeps_;
  const SweepForm form_;
  const StepSweeps of_step_;
  ExtraWork extra_;
  int tile_ = 0;
};

} // namespace

std::vector<PassTask> order_pass(const Lattice& lattice, const RowOrder& rows,
                                 std::span<const SweepRows> sweeps, SweepForm form,
                                 std::span<const LinkedRows> extra, StepSweeps of_step) {
  Order order(lattice, rows, sweeps, form, extra, of_step);
  const auto add = [&](std::span<const BodyGroup> groups) {
    for (const BodyGroup& group : groups) order.add_group(group);
  };
  if (rows.is_by_number())
    add(body_groups(lattice, all_rows(sweeps), extra, form.is_in_row_order));
  else
    add(rows.groups());
  return std::move(order.tasks);
}

RowCuts cut_for_tiles(int first, int end, int width, int sweeps, int lanes) {
  const int between = sweeps - 1, all = end - first + between, most = std::max(width, 1);
  const int tiles = std::min((end - first + most - 1) / most, all / sweeps);
  RowCuts cuts{{}, sweeps};
  for (int t = 1; t < tiles; ++t)
    for (int n = 0; n <= between; ++n)
      cuts.at.push_back((first + int(long(all) * t / tiles) - between + n) * lanes);
  return cuts;
}

std::string tiles_text(int tile) {
  return tile == no_tiles ? "" : ", tiles of " + std::to_string(tile) + " rows";
}

int most_rows_across(const Lattice& lattice, const RowDivision& division, bool is_in_row_order,
                     std::span<const LinkedRows> extra) {
  int most = 0;
  const auto add = [&](std::span<const BodyGroup> groups) {
    for (const BodyGroup& group : groups)
      if (!group.is_linked()) most = std::max(most, group.members().front().planes.across);
  };
  if (!division.order.is_by_number()) add(division.order.groups());
  for (int b = 0; b < division.blocks() && division.order.is_by_number(); ++b)
    add(body_groups(lattice, {division.cuts[std::size_t(b)], division.cuts[std::size_t(b) + 1]},
                    extra, is_in_row_order));
  return most;
}

} // namespace dss
