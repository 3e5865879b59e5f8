/// The order of the tasks of a pass, and the places of what they leave for one another.
#include "variants/engine/filled_rows.hpp"
#include "variants/engine/pass_places.hpp"
#include "variants/engine/seams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

namespace dss {
namespace {

/// Two bodies with holes, one of them a plate.
Lattice scattered_bodies(int nx, int ny, int nz, unsigned seed) {
  Lattice lattice;
  std::mt19937 generator(seed);
  for (const int body : {0, 1}) {
    const int layers = body == 0 ? nz : 1;
    VoxelGrid grid{
        nx, ny, layers,
        std::vector<std::uint8_t>(std::size_t(nx) * std::size_t(ny) * std::size_t(layers))};
    for (auto& cell : grid.occupied) cell = generator() % 3 != 0;
    append_body(lattice, grid, body);
  }
  return lattice;
}

/// The same bodies with merged rows, whose upper rows across y and z are one.
Lattice merged(const Lattice& cells) {
  constexpr RowCosts of_rows{100, 0};
  return FilledRows(cells, 8, std::array{of_rows, of_rows}, RowForm::merged).lattice();
}

/// How rows are held.
enum class Held { cells, merged, cut };

Lattice held(const Lattice& cells, Held how) {
  return how == Held::cells    ? cells
         : how == Held::merged ? merged(cells)
                               : cut_into_pieces(cells, {2, 3, 4, 7});
}

/// Sweeps over a block of rows and the halo that later sweeps read.
std::vector<SweepRows> sweeps_of(const Lattice& lattice, int begin, int end, int count,
                                 std::span<const LinkedRows> extra = {}) {
  RowDivision division;
  division.halo = division.order.halo(lattice, extra);
  division.cuts = {begin, end};
  return block_sweeps(division, int(lattice.rows.size()), count).front();
}

struct Case {
  Lattice lattice;
  RowOrder order;
  std::vector<SweepRows> sweeps;
  SweepForm form;
  std::vector<LinkedRows> extra;
};

/// No extra links; some within the first body and of a row with itself, which leave the second body
/// alone; the same and some between the bodies, which are long.
std::vector<std::vector<LinkedRows>> sets_of_links(const Lattice& lattice) {
  const int rows = int(lattice.rows.size());
  return {{}, {{0, 2}, {3, 3}}, {{0, 4}, {rows - 1, 1}, {rows - 2, 2}, {3, 3}, {rows - 2, 2}}};
}

/// Calls check(case) for blocks that hand over rows where they meet, in the order of sweeps.
template <class Check>
void each_handed_over(const Lattice& lattice, const std::vector<LinkedRows>& extra, int count,
                      SweepForm form, Check&& check) {
  const int rows = int(lattice.rows.size());
  RowDivision division;
  division.order = RowOrder(lattice, extra);
  division.halo = division.order.halo(lattice, extra);
  division.seams = SeamKind::handed_over;
  division.cuts = {0, rows / 3, rows / 3 + 1, rows / 2, rows};
  for (const std::vector<SweepRows>& sweeps : block_sweeps(division, rows, count))
    check(Case{lattice, division.order, sweeps, form, extra});
}

/// Calls check(case) for blocks, sweeps and tiles of awkward sizes.
template <class Check>
void each_case(Check&& check) {
  for (const auto& [ny, nz] : {std::pair{7, 5}, {3, 9}, {11, 1}})
    for (const int count : {1, 2, 4, 8})
      for (const int tile : {no_tiles, 1, 2, 3, 5, 50})
        for (const auto& [is_in_row_order, how] : {std::pair{false, Held::cells},
                                                   {true, Held::cells},
                                                   {false, Held::merged},
                                                   {false, Held::cut},
                                                   {true, Held::cut}}) {
          if (how == Held::cut && nz > 1) continue; // only rows of plates are cut
          const SweepForm form{tile, is_in_row_order};
          const Lattice lattice = held(scattered_bodies(9, ny, nz, unsigned(ny)), how);
          const int rows = int(lattice.rows.size());
          for (const std::vector<LinkedRows>& extra : sets_of_links(lattice)) {
            if (how == Held::cut && !extra.empty()) continue;
            for (const auto& [begin, end] :
                 {std::pair{0, rows}, {rows / 3, rows}, {0, rows / 2}, {rows / 3, rows / 2}})
              check(Case{lattice, {}, sweeps_of(lattice, begin, end, count, extra), form, extra});
            if (!is_in_row_order) each_handed_over(lattice, extra, count, form, check);
          }
        }
}

std::vector<PassTask> order_of(const Case& c) {
  return order_pass(c.lattice, c.order, c.sweeps, c.form, c.extra);
}

TEST(PassOrder, ComputesEachRowOfASweepOnce) {
  each_case([](const Case& c) {
    std::map<std::pair<int, int>, int> times;
    for (const PassTask& task : order_of(c))
      if (task.work == RowWork::stage) ++times[{task.sweep, task.row}];
    std::size_t all = 0;
    for (std::size_t n = 0; n < c.sweeps.size(); ++n) {
      for (int r = c.sweeps[n].begin; r < c.sweeps[n].end; ++r)
        EXPECT_EQ((times[{int(n), c.order.row(r)}]), 1) << "sweep " << n << ", place " << r;
      all += std::size_t(std::max(0, c.sweeps[n].end - c.sweeps[n].begin));
    }
    EXPECT_EQ(times.size(), all);
  });
}

/// Whether the case's block computes a row in a sweep.
bool computes(const Case& c, int sweep, int row) {
  return c.sweeps[std::size_t(sweep)].has(c.order.place(row));
}

/// Whether a task of a row leaves links across an axis.
bool leaves(const PassTask& task, int axis) {
  const std::map<RowWork, int> alone{
      {RowWork::upper_link_x, 0}, {RowWork::upper_link_y, 1}, {RowWork::upper_link_z, 2}};
  const auto found = alone.find(task.work);
  return found == alone.end() || found->second == axis;
}

/// The rows whose output of the sweep before a task reads.
std::vector<int> rows_read(const Case& c, const PassTask& task) {
  if (task.work == RowWork::extra_sum) return {};
  if (task.work == RowWork::extra_link) {
    const LinkedRows& link = c.extra[std::size_t(task.row)];
    return {link.i, link.j};
  }
  const Row& row = c.lattice.rows[std::size_t(task.row)];
  std::vector<int> rows{task.row};
  for (const int axis : {0, 1, 2})
    if (row.upper(axis) >= 0 && leaves(task, axis)) rows.push_back(row.upper(axis));
  return rows;
}

/// A row needs what the sweep before left in it and in its upper rows, and the links of its lower
/// rows. A method in place has overwritten none of them.
TEST(PassOrder, ComesToARowAfterAllThatItReads) {
  each_case([](const Case& c) {
    std::map<std::pair<int, int>, std::size_t> done;
    std::map<std::tuple<int, int, int>, bool> is_left;
    for (const PassTask& task : order_of(c)) {
      const int before = task.sweep - 1;
      for (const int read : rows_read(c, task)) {
        EXPECT_TRUE((before < 0 || !computes(c, before, read) || done.contains({before, read})));
        EXPECT_FALSE(done.contains({task.sweep, read})) << "the row is a sweep too far";
      }
      if (task.is_extra()) continue;
      const Row& row = c.lattice.rows[std::size_t(task.row)];
      if (task.work == RowWork::stage) {
        done[{task.sweep, task.row}] = 1;
        for (const int axis : {0, 1, 2}) {
          EXPECT_TRUE((row.lower(axis) < 0 || is_left[{axis, task.sweep, row.lower(axis)}]));
        }
      }
      for (const int axis : {0, 1, 2})
        if (leaves(task, axis)) is_left[{axis, task.sweep, task.row}] = true;
    }
  });
}

TEST(PassOrder, AddsUpExtraLinksBeforeTheirRows) {
  each_case([](const Case& c) {
    std::map<std::pair<int, int>, int> computed; // by sweep and link
    const PassTask* before = nullptr;
    const std::vector<PassTask> order = order_of(c);
    for (const PassTask& task : order) {
      const auto has = [&](const LinkedRows& link) {
        return link.i == task.row || link.j == task.row;
      };
      const bool is_linked = std::any_of(c.extra.begin(), c.extra.end(), has);
      if (task.work == RowWork::extra_link) {
        EXPECT_EQ((computed[{task.sweep, task.row}]++), 0);
      } else if (task.work == RowWork::stage && is_linked) {
        ASSERT_NE(before, nullptr);
        EXPECT_EQ(before->work, RowWork::extra_sum);
        EXPECT_EQ(std::pair(before->sweep, before->row), std::pair(task.sweep, task.row));
        for (std::size_t n = 0; n < c.extra.size(); ++n) {
          EXPECT_TRUE((!has(c.extra[n]) || computed.contains({task.sweep, int(n)})));
        }
      }
      before = &task;
    }
  });
}

TEST(RowCuts, LeaveAPackForEachSweepBetweenTiles) {
  constexpr int lanes = 8;
  for (const int sweeps : {1, 4, 8})
    for (const int first : {0, 3})
      for (const int packs : {1, 7, 8, 40, 125, 250})
        for (const int width : {0, 1, 20, 60, 250}) {
          const auto [at, pieces] = cut_for_tiles(first, first + packs, width, sweeps, lanes);
          std::vector<int> sizes; // of each piece
          for (int from = first * lanes; const int to : at) {
            EXPECT_EQ(to % lanes, 0);
            sizes.push_back((to - from) / lanes), from = to;
          }
          if (at.empty()) {
            EXPECT_TRUE(width >= packs || packs < 1 + sweeps);
            continue;
          }
          sizes.push_back(first + packs - at.back() / lanes);
          EXPECT_EQ(pieces, sweeps);
          const int tiles = (int(sizes.size()) + sweeps - 1) / sweeps;
          EXPECT_EQ(int(sizes.size()), tiles * sweeps - (sweeps - 1));
          std::vector<int> wide;
          for (int n = 0; n < int(sizes.size()); ++n) {
            if (n % sweeps == 0) wide.push_back(sizes[std::size_t(n)]);
            EXPECT_TRUE(n % sweeps == 0 || sizes[std::size_t(n)] == 1);
          }
          const auto [least, most] = std::ranges::minmax(wide);
          EXPECT_GE(least, 1);
          EXPECT_LE(most, least + 1);
          EXPECT_LE(most, std::max(width, sweeps));
        }
}

/// Writes the name of what each task leaves into its place, and looks whether it is still there
/// when it is read.
TEST(PassPlaces, KeepWhatIsStillRead) {
  const std::vector<std::vector<int>> increments{{}, {}, {}, {0, 1, 2}};
  each_case([&](const Case& c) {
    const int sweeps = int(c.sweeps.size()), stages = sweeps == 4 ? 4 : 1;
    const std::vector<PassTask> order = order_of(c);
    for (const bool is_filled : {false, true}) {
      const PassPlaces places(c.lattice, c.order, order, sweeps, stages, increments, c.extra,
                              is_filled);
      std::map<int, std::pair<int, int>> stage_rows, links[3];
      for (const PassTask& task : order) {
        const int stage = task.sweep % stages;
        const auto expect_kept = [&](int read, int r) {
          EXPECT_EQ(stage_rows[places.stage_row(read, r)], std::pair(read, r));
        };
        if (stage > 0)
          for (const int r : rows_read(c, task))
            if (computes(c, stage - 1, r)) expect_kept(stage - 1, r);
        if (task.is_extra()) continue;
        const Row& row = c.lattice.rows[std::size_t(task.row)];
        if (task.work == RowWork::stage)
          for (const int m : increments[std::size_t(stage)])
            if (computes(c, m, task.row)) expect_kept(m, task.row);
        for (const int axis : {0, 1, 2}) {
          auto& of_axis = links[axis];
          const int lower = row.lower(axis), upper = row.upper(axis);
          if (task.work == RowWork::stage && lower >= 0) {
            EXPECT_EQ(of_axis[places.links(axis, task.sweep, lower)],
                      std::pair(int(task.sweep), lower));
          }
          if (upper >= 0 && leaves(task, axis))
            of_axis[places.links(axis, task.sweep, task.row)] = {task.sweep, task.row};
        }
        if (task.work == RowWork::stage && stage + 1 < stages) {
          const int place = places.stage_row(stage, task.row);
          EXPECT_LT(place, places.stage_rows_size());
          stage_rows[place] = {stage, task.row};
        }
      }
    }
  });
}

TEST(PassPlaces, OfOneTileAreThoseOfAFewPlanes) {
  Lattice block;
  append_body(block, {8, 20, 40, std::vector<std::uint8_t>(8 * 20 * 40, 1)}, 0);
  const std::vector<SweepRows> sweeps = sweeps_of(block, 0, 20 * 40, 4);
  const RowOrder by_number;
  const PassPlaces places(block, by_number, order_pass(block, by_number, sweeps, {}), 4, 4,
                          {{}, {}, {}, {0, 1, 2}}, {}, false);
  EXPECT_LE(places.stage_rows_size(), 6 * 20 + 10); // 3 + 2 + 1 planes
  EXPECT_LE(places.links_size(2), 4 * 20 + 4);
  EXPECT_LE(places.links_size(1), 4 + 4);
}

/// What a row leaves may not reach into what another one left.
TEST(PassPlaces, OfRowsOfUnequalSizesLieApart) {
  const Lattice lattice = held(scattered_bodies(9, 11, 1, 5), Held::cut);
  std::vector<int> sizes;
  for (const Row& row : lattice.rows) sizes.push_back(row.x_end - row.x_begin);
  const std::vector<SweepRows> sweeps = sweeps_of(lattice, 0, int(lattice.rows.size()), 4);
  const RowOrder by_number;
  const std::vector<PassTask> order = order_pass(lattice, by_number, sweeps, {2});
  const PassPlaces places(lattice, by_number, order, 4, 4, {{}, {}, {}, {0, 1, 2}}, {}, false,
                          {sizes, sizes});
  std::map<int, int> end_of; // of each place
  for (int stage = 0; stage < 3; ++stage)
    for (int r = 0; r < int(lattice.rows.size()); ++r) {
      int& end = end_of[places.stage_row(stage, r)];
      end = std::max(end, places.stage_row(stage, r) + sizes[std::size_t(r)]);
    }
  int end = 0;
  for (const auto& [begin, place_end] : end_of) {
    EXPECT_LE(end, begin);
    end = place_end;
  }
  EXPECT_LE(end, places.stage_rows_size());
}

TEST(PassPlaces, OfAFilledRowAreNotThoseThatItReads) {
  const std::vector<std::vector<int>> increments{{}, {}, {}, {0, 1, 2}};
  each_case([&](const Case& c) {
    const int sweeps = int(c.sweeps.size()), stages = sweeps == 4 ? 4 : 1;
    const std::vector<PassTask> order = order_of(c);
    const PassPlaces places(c.lattice, c.order, order, sweeps, stages, increments, c.extra, true);
    for (const PassTask& task : order) {
      if (task.work != RowWork::stage) continue;
      const Row& row = c.lattice.rows[std::size_t(task.row)];
      for (const int axis : {1, 2})
        if (row.lower(axis) >= 0 && row.upper(axis) >= 0) {
          EXPECT_NE(places.links(axis, task.sweep, row.lower(axis)),
                    places.links(axis, task.sweep, task.row));
        }
    }
  });
}

} // namespace
} // namespace dss
