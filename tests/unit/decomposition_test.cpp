#include "solver/decomposition/decomposition.hpp"
#include "solver/decomposition/part.hpp"
#include "solver/error.hpp"
#include "tests/fixtures/decompositions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

namespace dss {
namespace {

using fixture::decompositions_of;
using fixture::described;
using fixture::divisible_problems;
using fixture::owners;

std::string refusal(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// The cost of each part: the sum over its elements.
std::vector<double> costs(const Problem& problem, const Decomposition& decomposition,
                          const Weights& weights = {}) {
  std::vector<double> sum(std::size_t(decomposition.parts), 0);
  const std::vector<int> owner = owners(problem, decomposition);
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int) {
    sum[std::size_t(owner[element])] +=
        weights.body_cost.empty() ? 1 : weights.body_cost[std::size_t(row.body)];
  });
  return sum;
}

TEST(decomposition, every_element_belongs_to_one_part_and_no_part_is_empty) {
  for (const Problem& problem : divisible_problems())
    for (const Decomposition& decomposition : decompositions_of(problem)) {
      SCOPED_TRACE(described(problem, decomposition));
      std::vector<std::size_t> elements(std::size_t(decomposition.parts), 0);
      for (const int owner : owners(problem, decomposition)) {
        ASSERT_GE(owner, 0);
        ASSERT_LT(owner, decomposition.parts);
        ++elements[std::size_t(owner)];
      }
      EXPECT_EQ(std::count(elements.begin(), elements.end(), 0U), 0);
      EXPECT_NO_THROW(require_fit(decomposition, problem.lattice));
    }
}

TEST(decomposition, shares_are_ascending_and_merged) {
  for (const Problem& problem : divisible_problems())
    for (const Decomposition& decomposition : decompositions_of(problem))
      for (std::size_t k = 1; k < decomposition.shares.size(); ++k) {
        const Share &before = decomposition.shares[k - 1], &here = decomposition.shares[k];
        ASSERT_LE(before.segment.row, here.segment.row);
        if (before.segment.row != here.segment.row) continue;
        ASSERT_LE(before.segment.x_end, here.segment.x_begin) << described(problem, decomposition);
        ASSERT_NE(before.part, here.part) << described(problem, decomposition);
      }
}

TEST(decomposition, the_same_arguments_give_the_same_parts) {
  for (const Problem& problem : divisible_problems())
    for (const Decomposition& decomposition : decompositions_of(problem))
      EXPECT_EQ(decompose(problem, decomposition.method, decomposition.parts).shares,
                decomposition.shares);
}

TEST(decomposition, as_many_parts_as_elements_give_one_element_each) {
  for (const Problem& problem : divisible_problems()) {
    const int parts = int(problem.lattice.element_count);
    EXPECT_EQ(costs(problem, decompose(problem, "blocks", parts)),
              std::vector<double>(std::size_t(parts), 1))
        << problem.name;
  }
}

TEST(decomposition, strips_are_contiguous_ranges_of_whole_rows) {
  const Problem problem = fixture::make_block(6, 5, 4, LinkLaw::material);
  const Decomposition strips = decompose(problem, "strips", 7);
  ASSERT_EQ(strips.shares.size(), problem.lattice.rows.size());
  for (std::size_t k = 1; k < strips.shares.size(); ++k)
    EXPECT_TRUE(strips.shares[k].part == strips.shares[k - 1].part ||
                strips.shares[k].part == strips.shares[k - 1].part + 1);
}

TEST(decomposition, blocks_of_a_plate_are_squares) {
  const Problem problem = fixture::make_plate(12);
  const Decomposition blocks = decompose(problem, "blocks", 4);
  EXPECT_EQ(costs(problem, blocks), std::vector<double>(4, 36));
  EXPECT_EQ(cut_links(problem, blocks), 24U);
  for (const Share& share : blocks.shares)
    EXPECT_EQ(share.segment.x_end - share.segment.x_begin, 6);
}

TEST(decomposition, blocks_of_a_cube_cut_all_three_axes) {
  Problem problem = fixture::make_block(8, 8, 8, LinkLaw::paper);
  problem.bodies[0].edge = {0.1, 0.1, 0.1};
  const Decomposition blocks = decompose(problem, "blocks", 8);
  EXPECT_EQ(costs(problem, blocks), std::vector<double>(8, 64));
  EXPECT_EQ(cut_links(problem, blocks), 3U * 64);
}

TEST(decomposition, the_extent_that_blocks_cut_is_in_metres) {
  Problem problem = fixture::make_block(8, 4, 1, LinkLaw::paper);
  problem.bodies[0].edge = {0.1, 1, 0.1};
  const Decomposition blocks = decompose(problem, "blocks", 2);
  EXPECT_EQ(cut_links(problem, blocks), 8U); // across y, which has fewer elements but is longer
}

TEST(decomposition, costs_follow_the_speeds) {
  const Weights weights{{1, 1, 2}, {}};
  const Problem problem = fixture::make_plate(40);
  for (const std::string_view method : decomposition_methods()) {
    if (!why_no_decomposition(method).empty()) continue;
    const std::vector<double> cost = costs(problem, decompose(problem, method, 3, weights));
    EXPECT_NEAR(cost[0], 400, 40) << method; // one row, or 10 %
    EXPECT_NEAR(cost[1], 400, 40) << method;
    EXPECT_NEAR(cost[2], 800, 40) << method;
  }
}

TEST(decomposition, costs_follow_the_bodies) {
  Problem problem = fixture::make_block(10, 10, 1, LinkLaw::paper);
  Body second = fixture::soft_body(LinkLaw::paper);
  second.origin = {0, 10 * second.edge[1], 0};
  fixture::add_block(problem, second, 10, 10, 1);
  problem.extra_links = {{95, 105, 1, LinkLaw::paper, second.axis[1]}};
  const Weights weights{{}, {1, 3}};
  for (const std::string_view method : decomposition_methods()) {
    if (!why_no_decomposition(method).empty()) continue;
    const std::vector<double> cost =
        costs(problem, decompose(problem, method, 4, weights), weights);
    EXPECT_NEAR(*std::max_element(cost.begin(), cost.end()), 100, 30)
        << method; // a row of the more expensive body
  }
}

TEST(decomposition, metis_gives_connected_parts_of_a_plate) {
  if (!why_no_decomposition("metis").empty()) GTEST_SKIP() << why_no_decomposition("metis");
  const Problem problem = fixture::make_plate(30);
  const Decomposition decomposition = decompose(problem, "metis", 7);
  const std::vector<int> owner = owners(problem, decomposition);
  std::vector<std::size_t> root(owner.size());
  for (std::size_t e = 0; e < root.size(); ++e) root[e] = e;
  const auto top = [&](std::size_t e) {
    while (root[e] != e) e = root[e];
    return e;
  };
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int) {
    if (owner[i] == owner[j]) root[top(i)] = top(j);
  });
  std::size_t groups = 0;
  for (std::size_t e = 0; e < root.size(); ++e) groups += root[e] == e;
  EXPECT_EQ(groups, 7U);
  EXPECT_LT(cut_links(problem, decomposition), cut_links(problem, decompose(problem, "strips", 7)));
}

TEST(decomposition, cut_links_are_those_between_owners) {
  for (const Problem& problem : divisible_problems())
    for (const Decomposition& decomposition : decompositions_of(problem)) {
      const std::vector<int> owner = owners(problem, decomposition);
      std::size_t expected = 0;
      problem.lattice.for_each_link(
          [&](std::size_t i, std::size_t j, int) { expected += owner[i] != owner[j]; });
      for (const ExtraLink& link : problem.extra_links) expected += owner[link.i] != owner[link.j];
      EXPECT_EQ(cut_links(problem, decomposition), expected) << described(problem, decomposition);
    }
}

TEST(decomposition, impossible_arguments_are_refused_with_what_would_be_right) {
  const Problem problem = fixture::make_block(3, 2, 1, LinkLaw::paper);
  const auto said = [&](std::string_view method, int parts, const Weights& weights = {}) {
    return refusal([&] { decompose(problem, method, parts, weights); });
  };
  EXPECT_PRED2(contains, said("strip", 2), "did you mean \"strips\"?");
  EXPECT_PRED2(contains, said("strips", 3), "take at most 2");
  EXPECT_PRED2(contains, said("blocks", 7), "take at most 6");
  EXPECT_PRED2(contains, said("blocks", 0), "take 1 or more");
  EXPECT_PRED2(contains, said("blocks", 2, {{1, 1, 2}, {}}), "3 speeds for 2 parts");
  EXPECT_PRED2(contains, said("blocks", 2, {{1, 0}, {}}), "0 is not a positive");
  EXPECT_PRED2(contains, said("blocks", 2, {{}, {1, 2}}), "2 costs for 1 bodies");
}

TEST(decomposition, one_that_does_not_fit_is_refused_with_the_place) {
  const Problem problem = fixture::make_block(4, 2, 1, LinkLaw::paper);
  const auto said = [&](int parts, std::vector<Share> shares) {
    return refusal([&] { require_fit({"file", parts, std::move(shares)}, problem.lattice); });
  };
  const Share row0{{0, 0, 4}, 0}, row1{{1, 0, 4}, 1};
  EXPECT_EQ(said(2, {row0, row1}), "");
  EXPECT_PRED2(contains, said(3, {row0, row1}), "part 2 has no element");
  EXPECT_PRED2(contains, said(2, {row0, {{1, 0, 3}, 1}}), "row 1: the element at x = 3");
  EXPECT_PRED2(contains, said(2, {{{0, 1, 4}, 0}, row1}), "row 0: the element at x = 0");
  EXPECT_PRED2(contains, said(1, {row0}), "row 1: the element at x = 0");
  EXPECT_PRED2(contains, said(1, {}), "row 0: the element at x = 0");
  EXPECT_PRED2(contains, said(2, {{{0, 0, 4}, 0}, {{0, 3, 4}, 1}, row1}), "[0, 3, 4]");
  EXPECT_PRED2(contains, said(2, {row1, row0}), "row 0: the element");
  EXPECT_PRED2(contains, said(2, {row0, row1, {{2, 0, 4}, 1}}), "rows are 0 .. 1");
  EXPECT_PRED2(contains, said(2, {row0, {{1, 0, 5}, 1}}), "x = 0 .. 3");
  EXPECT_PRED2(contains, said(2, {row0, {{1, 2, 2}, 1}}), "[1, 2, 2]");
  EXPECT_PRED2(contains, said(2, {row0, {{1, 0, 4}, 2}}), "parts are 0 .. 1");
}

TEST(decomposition, holes_need_no_owner_and_elements_between_them_do) {
  Problem problem;
  append_body(problem.lattice, {6, 1, 1, {1, 1, 0, 1, 0, 1}}, 0);
  const auto said = [&](std::vector<Share> shares) {
    return refusal([&] { require_fit({"file", 2, std::move(shares)}, problem.lattice); });
  };
  EXPECT_EQ(said({{{0, 0, 2}, 0}, {{0, 3, 6}, 1}}), "");
  EXPECT_PRED2(contains, said({{{0, 0, 2}, 0}, {{0, 5, 6}, 1}}), "x = 3");
  EXPECT_PRED2(contains, said({{{0, 0, 6}, 0}, {{0, 4, 5}, 1}}), "overlaps");
}

} // namespace
} // namespace dss
