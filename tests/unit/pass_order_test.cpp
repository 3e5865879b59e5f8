/// The order of a pass, the places of what its tasks leave for one another, and its fetches.
#include "variants/engine/body_group.hpp"
#include "variants/engine/fetch_plan.hpp"
#include "variants/engine/filled_rows.hpp"
#include "variants/engine/pass_places.hpp"
#include "variants/engine/seams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
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
                      int tile, Check&& check) {
  const int rows = int(lattice.rows.size());
  RowDivision division;
  division.order = RowOrder(lattice, extra);
  division.halo = division.order.halo(lattice, extra);
  division.seams = SeamKind::handed_over;
  division.cuts = {0, rows / 3, rows / 3 + 1, rows / 2, rows};
  for (const std::vector<SweepRows>& sweeps : block_sweeps(division, rows, count))
    check(Case{lattice, division.order, sweeps, {tile, false}, extra});
}

/// Calls check(case) for blocks, sweeps and tiles of awkward sizes.
template <class Check>
void each_case(Check&& check) {
  for (const auto& [ny, nz] : {std::pair{7, 5}, {3, 9}, {11, 1}})
    for (const int count : {1, 2, 4, 8})
      for (const int tile : {no_tiles, 1, 2, 3, 5, 50})
        for (const auto& [is_in_row_order, is_merged] :
             {std::pair{false, false}, {true, false}, {false, true}}) {
          const Lattice cells = scattered_bodies(9, ny, nz, unsigned(ny));
          const Lattice lattice = is_merged ? merged(cells) : cells;
          const int rows = int(lattice.rows.size());
          for (const std::vector<LinkedRows>& extra : sets_of_links(lattice))
            for (const auto& [begin, end] :
                 {std::pair{0, rows}, {rows / 3, rows}, {0, rows / 2}, {rows / 3, rows / 2}})
              check(Case{lattice,
                         {},
                         sweeps_of(lattice, begin, end, count, extra),
                         {tile, is_in_row_order},
                         extra});
          for (const std::vector<LinkedRows>& extra : sets_of_links(lattice))
            each_handed_over(lattice, extra, count, tile, check);
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

/// The rows whose output of the sweep before a task reads.
std::vector<int> rows_read(const Case& c, const PassTask& task) {
  if (task.work == RowWork::extra_sum) return {};
  if (task.work == RowWork::extra_link) {
    const LinkedRows& link = c.extra[std::size_t(task.row)];
    return {link.i, link.j};
  }
  const Row& row = c.lattice.rows[std::size_t(task.row)];
  std::vector<int> rows{task.row};
  if (row.upper_y >= 0 && task.work != RowWork::upper_link_z) rows.push_back(row.upper_y);
  if (row.upper_z >= 0 && task.work != RowWork::upper_link_y) rows.push_back(row.upper_z);
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
        EXPECT_TRUE((row.lower_y < 0 || is_left[{1, task.sweep, row.lower_y}]));
        EXPECT_TRUE((row.lower_z < 0 || is_left[{2, task.sweep, row.lower_z}]));
      }
      if (task.work != RowWork::upper_link_z) is_left[{1, task.sweep, task.row}] = true;
      if (task.work != RowWork::upper_link_y) is_left[{2, task.sweep, task.row}] = true;
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

Lattice plates(const std::vector<std::pair<int, int>>& sizes) {
  Lattice lattice;
  for (int body = 0; body < int(sizes.size()); ++body) {
    const auto [ny, nz] = sizes[std::size_t(body)];
    append_body(lattice, {2, ny, nz, std::vector<std::uint8_t>(std::size_t(2 * ny * nz), 1)}, body);
  }
  return lattice;
}

TEST(BodyGroups, AreShiftedSoThatLinkedRowsAreClose) {
  const Lattice lattice = plates({{20, 1}, {30, 1}, {5, 1}});
  // The end of the first to the start of the second; the third is alone.
  const std::vector<LinkedRows> ends{{19, 20}};
  const std::vector<BodyGroup> groups = body_groups(lattice, {0, 55}, ends, false);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].lag(), 1);
  EXPECT_EQ(groups[0].members()[1].shift, 19);
  EXPECT_EQ(groups[0].planes(), 49);
  EXPECT_EQ(groups[0].rows_behind(), 2);
  EXPECT_FALSE(groups[1].is_linked());
  // Links that pull apart: each is two planes long, which is the least.
  const std::vector<LinkedRows> apart{{4, 20}, {0, 20}};
  EXPECT_EQ(body_groups(lattice, {0, 55}, apart, false).front().lag(), 3);
}

TEST(BodyGroups, ThatAreLinkedHaveNoRowsForTiles) {
  const Lattice lattice = plates({{9, 4}, {9, 7}});
  const std::vector<LinkedRows> in_first{{0, 9}}, between{{0, 36}};
  RowDivision division;
  division.cuts = {0, 99};
  EXPECT_EQ(most_rows_across(lattice, division, false, {}), 7);
  EXPECT_EQ(most_rows_across(lattice, division, false, in_first), 7);
  EXPECT_EQ(most_rows_across(lattice, division, false, between), 0);
  division.cuts = {0, 36};
  EXPECT_EQ(most_rows_across(lattice, division, false, {}), 4);
  division.order = RowOrder(lattice, in_first);
  EXPECT_EQ(most_rows_across(lattice, division, false, in_first), 7);
}

TEST(BodyGroups, TakeTheDirectionOfTheirLinks) {
  // Planes along the longer side of each body would put one row of links beside many planes.
  const Lattice lattice = plates({{20, 4}, {6, 20}});
  std::vector<LinkedRows> links;
  for (int z = 0; z < 4; ++z) links.push_back({z * 20, 80 + z * 6});
  const std::vector<BodyGroup> groups = body_groups(lattice, {0, 200}, links, false);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].lag(), 1);
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
      std::map<int, std::pair<int, int>> stage_rows, links[2];
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
        for (const int axis : {1, 2}) {
          auto& of_axis = links[axis - 1];
          const int lower = row.lower(axis), upper = row.upper(axis);
          if (task.work == RowWork::stage && lower >= 0) {
            EXPECT_EQ(of_axis[places.links(axis, task.sweep, lower)],
                      std::pair(int(task.sweep), lower));
          }
          const RowWork other = axis == 1 ? RowWork::upper_link_z : RowWork::upper_link_y;
          if (upper >= 0 && task.work != other)
            of_axis[places.links(axis, task.sweep, task.row)] = {task.sweep, task.row};
        }
        if (task.work == RowWork::stage && stage + 1 < stages) {
          const int place = places.stage_row(stage, task.row);
          EXPECT_LT(place, places.stage_row_count());
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
  EXPECT_LE(places.stage_row_count(), 6 * 20 + 10); // 3 + 2 + 1 planes
  EXPECT_LE(places.links_count(2), 4 * 20 + 4);
  EXPECT_LE(places.links_count(1), 4 + 4);
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

TEST(FetchPlan, FetchesEarlyEnoughAlongWithOneTaskEach) {
  const std::vector<FetchPlan::Task> tasks(100, {8, 0});
  FetchPlan plan(tasks);
  std::vector<char> rows(100 * 64);
  for (std::size_t n = 0; n < 100; n += 2) plan.first_read(n, &rows[n * 64], 8 * 2 * 64);
  std::map<const char*, std::size_t> by;
  for (std::size_t n = 0; n < 100; ++n)
    if (const FetchPlan::Fetch& fetch = plan.fetches()[n]; fetch.row != nullptr) {
      EXPECT_TRUE(by.emplace(fetch.row, n).second);
      EXPECT_EQ(fetch.lines, 2);
      EXPECT_LE(long(n * 8) + FetchPlan::lead, (fetch.row - rows.data()) / 64 * 8);
    }
  EXPECT_GE(by.size(), 47U);
}

TEST(FetchPlan, ReadersOfLongRowsFetchThemThemselves) {
  FetchPlan plan({{100, 0}, {100, 1}});
  const std::vector<char> row(100 * 64);
  plan.first_read(1, row.data(), row.size());
  EXPECT_EQ(plan.fetches()[1].row, row.data() + FetchPlan::lead * 64);
  EXPECT_EQ(plan.fetches()[0].row, nullptr);
}

} // namespace
} // namespace dss
