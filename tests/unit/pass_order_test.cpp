/// The order of a pass, the places of what its tasks leave for one another, and its fetches.
#include "variants/engine/fetch_plan.hpp"
#include "variants/engine/pass_places.hpp"

#include <gtest/gtest.h>

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

/// Sweeps over a block of rows and the halo that later sweeps read.
std::vector<SweepRows> sweeps_of(const Lattice& lattice, int begin, int end, int count) {
  const int rows = int(lattice.rows.size());
  std::vector<SweepRows> sweeps;
  for (int n = 0; n < count; ++n) {
    const int halo = (count - 1 - n) * lattice.row_reach();
    sweeps.push_back({std::max(0, begin - halo), std::min(rows, end + halo)});
  }
  return sweeps;
}

struct Case {
  Lattice lattice;
  std::vector<SweepRows> sweeps;
  SweepForm form;
};

/// Calls check(case) for blocks, sweeps and tiles of awkward sizes.
template <class Check>
void each_case(Check&& check) {
  for (const auto& [ny, nz] : {std::pair{7, 5}, {3, 9}, {11, 1}})
    for (const int count : {1, 2, 4, 8})
      for (const int tile : {no_tiles, 1, 2, 3, 5, 50})
        for (const bool is_by_rows : {false, true}) {
          const Lattice lattice = scattered_bodies(9, ny, nz, unsigned(ny));
          const int rows = int(lattice.rows.size());
          for (const auto& [begin, end] :
               {std::pair{0, rows}, {rows / 3, rows}, {0, rows / 2}, {rows / 3, rows / 2}})
            check(Case{lattice, sweeps_of(lattice, begin, end, count), {tile, is_by_rows}});
        }
}

std::vector<PassTask> order_of(const Case& c) { return order_pass(c.lattice, c.sweeps, c.form); }

TEST(PassOrder, ComputesEachRowOfASweepOnce) {
  each_case([](const Case& c) {
    std::map<std::pair<int, int>, int> times;
    for (const PassTask& task : order_of(c))
      if (task.work == RowWork::stage) ++times[{task.sweep, task.row}];
    std::size_t all = 0;
    for (std::size_t n = 0; n < c.sweeps.size(); ++n) {
      for (int r = c.sweeps[n].begin; r < c.sweeps[n].end; ++r)
        EXPECT_EQ((times[{int(n), r}]), 1) << "sweep " << n << ", row " << r;
      all += std::size_t(c.sweeps[n].end - c.sweeps[n].begin);
    }
    EXPECT_EQ(times.size(), all);
  });
}

/// The rows whose output of the sweep before a task reads.
std::vector<int> rows_read(const PassTask& task, const Row& row) {
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
      const Row& row = c.lattice.rows[std::size_t(task.row)];
      const int before = task.sweep - 1;
      for (const int read : rows_read(task, row)) {
        EXPECT_TRUE((before < 0 || done.contains({before, read})));
        EXPECT_FALSE(done.contains({task.sweep, read})) << "the row is a sweep too far";
      }
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

/// Writes the name of what each task leaves into its place, and looks whether it is still there
/// when it is read.
TEST(PassPlaces, KeepWhatIsStillRead) {
  const std::vector<std::vector<int>> increments{{}, {}, {}, {0, 1, 2}};
  each_case([&](const Case& c) {
    const int sweeps = int(c.sweeps.size()), stages = sweeps == 4 ? 4 : 1;
    const std::vector<PassTask> order = order_of(c);
    const PassPlaces places(c.lattice, order, sweeps, stages, increments);
    std::map<int, std::pair<int, int>> stage_rows, links[2];
    for (const PassTask& task : order) {
      const Row& row = c.lattice.rows[std::size_t(task.row)];
      const int stage = task.sweep % stages;
      const auto expect_kept = [&](int read, int r) {
        EXPECT_EQ(stage_rows[places.stage_row(read, r)], std::pair(read, r));
      };
      if (stage > 0)
        for (const int r : {task.row, row.upper_y, row.upper_z})
          if (r >= 0) expect_kept(stage - 1, r);
      if (task.work == RowWork::stage)
        for (const int m : increments[std::size_t(stage)]) expect_kept(m, task.row);
      for (const int axis : {1, 2}) {
        auto& of_axis = links[axis - 1];
        const int lower = axis == 1 ? row.lower_y : row.lower_z,
                  upper = axis == 1 ? row.upper_y : row.upper_z;
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
  });
}

TEST(PassPlaces, OfOneTileAreThoseOfAFewPlanes) {
  Lattice block;
  append_body(block, {8, 20, 40, std::vector<std::uint8_t>(8 * 20 * 40, 1)}, 0);
  const std::vector<SweepRows> sweeps = sweeps_of(block, 0, 20 * 40, 4);
  const PassPlaces places(block, order_pass(block, sweeps, {}), 4, 4, {{}, {}, {}, {0, 1, 2}});
  EXPECT_LE(places.stage_row_count(), 6 * 20 + 10); // 3 + 2 + 1 planes
  EXPECT_LE(places.links_count(2), 4 * 20 + 4);
  EXPECT_LE(places.links_count(1), 4 + 4);
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
