/// The model of latency and bandwidth that judges halo strategies before a run.
#include "variants/cost/halo_cost.hpp"
#include "variants/cost/rounds.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

constexpr Network slow{1e-3, 1e-8, 0, 0}, busy{2e-5, 1e-10, 5e-6, 1e-9};
constexpr double compute_s = 1.0;

/// A chain of equal parts. Each sends `bytes` to both neighbours in each exchange.
PlannedStrategy chain(std::string name, int parts, const PartTimes& times, std::size_t bytes) {
  PlannedStrategy planned{std::move(name), 1, {}};
  if (find_halo_strategy(planned.name)->is_every_stage) planned.exchanges = 4;
  for (int p = 0; p < parts; ++p) {
    PlannedPart part{times, {}};
    if (p > 0) part.faces.push_back({p - 1, Side::lower, bytes, bytes});
    if (p + 1 < parts) part.faces.push_back({p + 1, Side::upper, bytes, bytes});
    planned.parts.push_back(part);
  }
  return planned;
}

TEST(HaloCost, of_a_part_without_neighbours_is_its_computation) {
  for (const HaloStrategy& one : halo_strategies())
    EXPECT_NEAR(predicted_step_s(chain(std::string(one.name), 1, {compute_s, 0.5, 0, 0}, 0), slow),
                compute_s, 1e-12)
        << one.name;
}

TEST(HaloCost, of_sendrecv_pays_a_message_for_each_round_and_stage) {
  const double message_s = 1e-3 + 500 * 1e-8;
  EXPECT_NEAR(predicted_step_s(chain("sendrecv", 2, {compute_s, 0, 0, 0}, 500), slow),
              compute_s + 4 * message_s, 1e-9);
  EXPECT_NEAR(predicted_step_s(chain("sendrecv", 9, {compute_s, 0, 0, 0}, 500), slow),
              compute_s + 8 * message_s, 1e-9);
}

TEST(HaloCost, of_deep_pays_one_latency_a_step_and_the_bytes_of_both_neighbours) {
  EXPECT_NEAR(predicted_step_s(chain("deep", 5, {compute_s, 0, 0, 0}, 2000), slow),
              compute_s + 1e-3 + 4000 * 1e-8, 1e-9);
}

TEST(HaloCost, of_overlap_pays_only_what_cannot_be_hidden) {
  const double exchange_s = 1e-3 + 1000 * 1e-8;
  EXPECT_NEAR(predicted_step_s(chain("overlap", 5, {compute_s, 0.5, 0, 0}, 500), slow), compute_s,
              1e-9);
  EXPECT_NEAR(predicted_step_s(chain("overlap", 5, {compute_s, 1e-3, 0, 0}, 500), slow),
              compute_s + 4 * exchange_s - 1e-3, 1e-9);
}

TEST(HaloCost, of_overlap_cannot_hide_what_the_processor_itself_does) {
  EXPECT_NEAR(predicted_step_s(chain("overlap", 5, {compute_s, 0.5, 0, 0}, 500), busy),
              compute_s + 4 * 2 * 2 * (5e-6 + 500 * 1e-9), 1e-9);
}

TEST(HaloCost, of_messages_too_large_to_copy_leaves_the_processor_alone) {
  const PartTimes split{compute_s, 0, 0.3, 0.3};
  const double step_s =
      predicted_step_s(chain("deep-overlap", 5, split, std::size_t(4 * eager_bytes)), busy);
  EXPECT_NEAR(step_s, compute_s, 1e-9);
}

TEST(HaloCost, of_an_edge_that_is_sent_early_is_the_mean_of_both_ways) {
  const Network far{0.3, 0, 0,
                    0}; // up: computed at 1, there at 1.3; down: computed at 0.2, there at 0.5
  EXPECT_NEAR(predicted_step_s(chain("deep-overlap", 6, {compute_s, 0, 0, 0.2}, 8), far), compute_s,
              1e-9);
  const Network farther{0.5, 0, 0, 0};
  EXPECT_NEAR(predicted_step_s(chain("deep-overlap", 6, {compute_s, 0, 0, 0.2}, 8), farther),
              (1.5 + 0.7) / 2, 1e-9);
}

TEST(HaloCost, of_shared_memory_is_less_than_that_of_messages) {
  EXPECT_LT(predicted_step_s(chain("shared", 4, {compute_s, 0, 0, 0}, 2000), busy),
            predicted_step_s(chain("deep", 4, {compute_s, 0, 0, 0}, 2000), busy));
}

TEST(HaloCost,
     prefers_few_large_messages_where_latency_rules_and_no_redundancy_where_bandwidth_does) {
  const auto step_s = [](const char* name, double seconds, std::size_t bytes,
                         const Network& network) {
    return predicted_step_s(chain(name, 4, {seconds, 0, 0, 0}, bytes), network);
  };
  const Network latency_rules{0.1, 1e-9, 0, 0}, bandwidth_rules{1e-9, 1e-9, 0, 0};
  EXPECT_LT(step_s("deep", 1.1, 40000, latency_rules),
            step_s("sendrecv", 1.0, 10000, latency_rules));
  EXPECT_GT(step_s("deep", 1.1, 40000, bandwidth_rules),
            step_s("sendrecv", 1.0, 10000, bandwidth_rules));
}

} // namespace
} // namespace dss::test
