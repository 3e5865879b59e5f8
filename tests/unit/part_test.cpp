#include "solver/decomposition/part.hpp"
#include "tests/fixtures/decompositions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

namespace dss {
namespace {

using fixture::decompositions_of;
using fixture::described;
using fixture::divisible_problems;
using fixture::global_numbers;
using fixture::owners;
using fixture::Place;
using fixture::places;

constexpr std::array<int, 3> depths = {0, 1, 4};

/// Calls visit(problem, decomposition) for every case of these tests.
template <class Visit>
void for_each_case(Visit&& visit) {
  for (const Problem& problem : divisible_problems())
    for (const Decomposition& decomposition : decompositions_of(problem)) {
      SCOPED_TRACE(described(problem, decomposition));
      visit(problem, decomposition);
    }
}

/// Layers by a search over cells: the distance of each element from those of a part.
std::map<std::size_t, int> layers_by_search(const Problem& problem, const std::vector<int>& owner,
                                            int part, int depth) {
  std::map<Place, std::optional<std::size_t>>
      cells; // all cells of all rows, with the elements in them
  for (const Row& row : problem.lattice.rows)
    for (int x = row.x_begin; x < row.x_end; ++x) cells[{row.body, row.z, row.y, x}] = std::nullopt;
  const std::vector<Place> place = places(problem.lattice);
  for (std::size_t e = 0; e < place.size(); ++e) cells[place[e]] = e;
  std::set<Place> reached;
  std::map<std::size_t, int> layer;
  for (std::size_t e = 0; e < place.size(); ++e)
    if (owner[e] == part) {
      reached.insert(place[e]);
      layer[e] = 0;
    }
  for (int k = 1; k <= depth; ++k) {
    std::set<Place> wider = reached;
    for (const Place& cell : reached) {
      for (std::size_t axis = 1; axis < 4; ++axis)
        for (const int step : {-1, 1}) {
          Place beside = cell;
          beside[axis] += step;
          if (cells.contains(beside)) wider.insert(beside);
        }
      for (const ExtraLink& link : problem.extra_links) {
        if (place[link.i] == cell) wider.insert(place[link.j]);
        if (place[link.j] == cell) wider.insert(place[link.i]);
      }
    }
    for (const Place& cell : wider)
      if (const auto element = cells.at(cell)) layer.emplace(*element, k);
    reached = std::move(wider);
  }
  return layer;
}

TEST(part, halo_layers_are_those_of_a_search_over_cells) {
  for_each_case([](const Problem& problem, const Decomposition& decomposition) {
    const std::vector<int> owner = owners(problem, decomposition);
    for (const int depth : depths)
      for (int index = 0; index < decomposition.parts; ++index) {
        const Part part = make_part(problem, decomposition, index, depth);
        const std::map<std::size_t, int> expected = layers_by_search(problem, owner, index, depth);
        const std::vector<std::size_t> global = global_numbers(problem, part);
        ASSERT_EQ(global.size(), expected.size());
        ASSERT_EQ(part.layer.size(), expected.size());
        auto next = expected.begin();
        for (std::size_t e = 0; e < global.size(); ++e, ++next) {
          ASSERT_EQ(global[e], next->first);
          ASSERT_EQ(part.layer[e], next->second);
        }
        EXPECT_EQ(part.index, index);
        EXPECT_EQ(part.depth, depth);
        EXPECT_EQ(part.own_elements,
                  std::size_t(std::count(part.layer.begin(), part.layer.end(), 0)));
      }
  });
}

TEST(part, own_elements_of_all_parts_are_the_problem) {
  for_each_case([](const Problem& problem, const Decomposition& decomposition) {
    for (const int depth : depths) {
      std::vector<int> times(problem.lattice.element_count, 0);
      for (int index = 0; index < decomposition.parts; ++index) {
        const Part part = make_part(problem, decomposition, index, depth);
        const std::vector<std::size_t> global = global_numbers(problem, part);
        std::size_t count = 0;
        for (std::size_t r = 0; r < part.runs.size(); ++r) {
          const dss::Run& run = part.runs[r];
          count += run.count;
          for (std::size_t k = 0; k < run.count; ++k) {
            ASSERT_EQ(global.at(run.local + k), run.global + k);
            ASSERT_EQ(part.layer[run.local + k], 0);
            ++times[run.global + k];
          }
          if (r == 0) continue;
          const dss::Run& before = part.runs[r - 1];
          ASSERT_GE(run.local, before.local + before.count);
          ASSERT_GE(run.global, before.global + before.count);
          ASSERT_TRUE(run.local > before.local + before.count ||
                      run.global > before.global + before.count);
        }
        EXPECT_EQ(count, part.own_elements);
      }
      EXPECT_EQ(std::count(times.begin(), times.end(), 1), std::ptrdiff_t(times.size()));
    }
  });
}

TEST(part, rows_are_the_originals_cut_to_the_cells_that_are_here) {
  for_each_case([](const Problem& problem, const Decomposition& decomposition) {
    for (const int depth : depths)
      for (int index = 0; index < decomposition.parts; ++index) {
        const Part part = make_part(problem, decomposition, index, depth);
        const Lattice& lattice = part.problem.lattice;
        ASSERT_EQ(part.global_row.size(), lattice.rows.size());
        ASSERT_TRUE(std::is_sorted(part.global_row.begin(), part.global_row.end()));
        std::size_t element = 0, cell = 0;
        const auto original_of = [&](int r) {
          return r < 0 ? -1 : part.global_row[std::size_t(r)];
        };
        for (std::size_t r = 0; r < lattice.rows.size(); ++r) {
          const Row& row = lattice.rows[r];
          const Row& original = problem.lattice.rows[std::size_t(part.global_row[r])];
          ASSERT_EQ(std::tie(row.body, row.y, row.z),
                    std::tie(original.body, original.y, original.z));
          ASSERT_EQ(row.first_element, element);
          ASSERT_EQ(row.first_cell, cell);
          ASSERT_TRUE(lattice.is_present(row, row.x_begin) &&
                      lattice.is_present(row, row.x_end - 1));
          for (int x = row.x_begin; x < row.x_end; ++x) element += lattice.is_present(row, x);
          cell += std::size_t(row.x_end - row.x_begin);
          const auto is_right = [&](int here, int there) {
            const bool is_here =
                std::binary_search(part.global_row.begin(), part.global_row.end(), there);
            return original_of(here) == (is_here ? there : -1);
          };
          EXPECT_TRUE(is_right(row.lower_y, original.lower_y) &&
                      is_right(row.upper_y, original.upper_y));
          EXPECT_TRUE(is_right(row.lower_z, original.lower_z) &&
                      is_right(row.upper_z, original.upper_z));
        }
        EXPECT_EQ(lattice.element_count, element);
        EXPECT_EQ(lattice.present.size(), cell);
      }
  });
}

TEST(part, links_are_the_originals_between_elements_that_are_here) {
  for_each_case([](const Problem& problem, const Decomposition& decomposition) {
    for (int index = 0; index < decomposition.parts; ++index) {
      const Part part = make_part(problem, decomposition, index, 1);
      const std::vector<std::size_t> global = global_numbers(problem, part);
      const std::set<std::size_t> here(global.begin(), global.end());
      std::set<std::array<std::size_t, 3>> expected, found;
      problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
        if (here.contains(i) && here.contains(j)) expected.insert({i, j, std::size_t(axis)});
      });
      part.problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
        found.insert({global[i], global[j], std::size_t(axis)});
      });
      EXPECT_EQ(found, expected);
      std::vector<std::array<std::size_t, 2>> extra, extra_here;
      for (const ExtraLink& link : problem.extra_links)
        if (here.contains(link.i) && here.contains(link.j)) extra.push_back({link.i, link.j});
      for (const ExtraLink& link : part.problem.extra_links)
        extra_here.push_back({global[link.i], global[link.j]});
      EXPECT_EQ(extra_here, extra);
    }
  });
}

TEST(part, what_one_part_sends_another_receives) {
  for_each_case([](const Problem& problem, const Decomposition& decomposition) {
    const std::vector<int> owner = owners(problem, decomposition);
    for (const int depth : depths) {
      using Ends = std::pair<int, int>; // from, to
      std::map<Ends, std::vector<std::size_t>> sent, received;
      for (int index = 0; index < decomposition.parts; ++index) {
        const Part part = make_part(problem, decomposition, index, depth);
        const std::vector<std::size_t> global = global_numbers(problem, part);
        const auto globals = [&](const std::vector<std::size_t>& local) {
          std::vector<std::size_t> numbers;
          for (const std::size_t e : local) numbers.push_back(global.at(e));
          EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
          return numbers;
        };
        std::size_t halo = 0;
        int last = -1;
        for (const Neighbour& neighbour : part.neighbours) {
          EXPECT_GT(neighbour.part, last);
          last = neighbour.part;
          halo += neighbour.receive.size();
          sent[{index, neighbour.part}] = globals(neighbour.send);
          received[{neighbour.part, index}] = globals(neighbour.receive);
          for (const std::size_t e : neighbour.send) ASSERT_EQ(part.layer.at(e), 0);
          for (const std::size_t e : received[{neighbour.part, index}])
            ASSERT_EQ(owner[e], neighbour.part);
        }
        EXPECT_EQ(halo, part.layer.size() - part.own_elements);
      }
      EXPECT_EQ(sent, received);
    }
  });
}

TEST(part, sizes_are_those_of_the_part) {
  for_each_case([](const Problem& problem, const Decomposition& decomposition) {
    for (const int depth : depths)
      for (int index = 0; index < decomposition.parts; ++index) {
        const Part part = make_part(problem, decomposition, index, depth);
        const PartSize size = part_size(problem, decomposition, index, depth);
        EXPECT_EQ(size.own_elements, part.own_elements);
        ASSERT_EQ(size.layer_elements.size(), std::size_t(depth));
        for (int k = 1; k <= depth; ++k)
          EXPECT_EQ(size.layer_elements[std::size_t(k) - 1],
                    std::size_t(std::count(part.layer.begin(), part.layer.end(), k)));
        std::vector<PartSize::Face> faces;
        for (const Neighbour& n : part.neighbours)
          faces.push_back({n.part, side_of(part, n), n.send.size(), n.receive.size()});
        EXPECT_EQ(size.faces, faces);
        std::set<int> rows;
        part.problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
          if (part.layer[e] == 0) rows.insert(int(&row - part.problem.lattice.rows.data()));
        });
        EXPECT_EQ(size.own_rows, int(rows.size()));
      }
  });
}

} // namespace
} // namespace dss
