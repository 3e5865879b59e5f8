/// The latency-bandwidth model by which a halo strategy is chosen.
#include "variants/halo_cost.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

constexpr Network slow{1e-3, 1e-8, 0, 0}, busy{1e-6, 1e-10, 5e-6, 1e-9};

const HaloStrategy& strategy(std::string_view name) { return *find_halo_strategy(name); }

TEST(HaloCost, of_a_part_without_neighbours_is_its_computation) {
  for (const HaloStrategy& one : halo_strategies())
    EXPECT_EQ(predicted_step_s(one, {2.0, 1.0, 4, 0, 0}, slow), 2.0) << one.name;
}

TEST(HaloCost, of_sendrecv_pays_a_latency_for_each_neighbour_and_stage) {
  const HaloCost cost{1.0, 0, 4, 2, 1000}; // 4 stages, 2 neighbours, 1000 bytes to both
  EXPECT_DOUBLE_EQ(predicted_step_s(strategy("sendrecv"), cost, slow), 1.0 + 4 * (2 * 1e-3 + 1000 * 1e-8));
}

TEST(HaloCost, of_deep_pays_one_latency_a_step) {
  EXPECT_DOUBLE_EQ(predicted_step_s(strategy("deep"), {1.0, 0, 1, 2, 4000}, slow), 1.0 + 1e-3 + 4000 * 1e-8);
}

TEST(HaloCost, of_overlap_pays_only_what_cannot_be_hidden) {
  const HaloCost hidden{1.0, 0.5, 4, 2, 1000}, bare{1.0, 1e-3, 4, 2, 1000};
  EXPECT_DOUBLE_EQ(predicted_step_s(strategy("overlap"), hidden, slow), 1.0);
  EXPECT_DOUBLE_EQ(predicted_step_s(strategy("overlap"), bare, slow), 1.0 + 4 * (1e-3 + 1000 * 1e-8) - 1e-3);
}

TEST(HaloCost, of_overlap_cannot_hide_what_the_processor_itself_does) {
  const HaloCost cost{1.0, 0.5, 4, 2, 1000};
  EXPECT_DOUBLE_EQ(predicted_step_s(strategy("overlap"), cost, busy), 1.0 + 2 * 4 * 2 * (5e-6 + 500 * 1e-9));
}

TEST(HaloCost, of_messages_too_large_to_copy_leaves_the_processor_alone) {
  const HaloCost cost{1.0, 0.5, 1, 2, 4 * eager_bytes};
  EXPECT_DOUBLE_EQ(predicted_step_s(strategy("deep-overlap"), cost, busy), 1.0);
}

TEST(HaloCost, chooses_few_large_messages_where_latency_rules_and_no_redundancy_where_bandwidth_does) {
  const HaloCost every_stage{1.0, 0, 4, 2, 1e5}, once{1.1, 0, 1, 2, 4e5};
  const Network latency_rules{0.1, 1e-9, 0, 0}, bandwidth_rules{1e-9, 1e-9, 0, 0};
  EXPECT_LT(predicted_step_s(strategy("deep"), once, latency_rules),
            predicted_step_s(strategy("sendrecv"), every_stage, latency_rules));
  EXPECT_GT(predicted_step_s(strategy("deep"), once, bandwidth_rules),
            predicted_step_s(strategy("sendrecv"), every_stage, bandwidth_rules));
}

} // namespace
} // namespace dss::test
