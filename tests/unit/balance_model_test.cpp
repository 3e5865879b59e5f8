/// The model of what two executors of different speed reach together, on cases that can be computed
/// by hand.
#include "variants/cost/balance_model.hpp"
#include "variants/cost/part_cost.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

constexpr double speed = 1e6;
constexpr double redundant_rows = 1.5; // (3 + 2 + 1) rows of stages, of 4 stages a row

/// A connection without cost.
ModelledPlate plate(int rows, double ratio) { return {rows, 4, speed * ratio, speed, {}}; }

TEST(BalanceModel, of_equals_without_transfers_loses_the_halo_that_both_compute_again) {
  const ModelledBalance model = modelled_balance(plate(100, 1));
  EXPECT_DOUBLE_EQ(model.fast_share, 0.5);
  EXPECT_NEAR(model.step_s, (50 + redundant_rows) * 100 / speed, 1e-12);
  EXPECT_NEAR(model.of_sum, 50 / 51.5, 1e-12);
  EXPECT_NEAR(model.of_fast, 2 * 50 / 51.5, 1e-12);
  EXPECT_NEAR(model.equal_split_of_fast, model.of_fast, 1e-12);
}

/// A part of rows of one element, between two others.
PartSize strip(int own_rows, int layers) {
  PartSize size;
  size.own_rows = own_rows;
  size.row_elements.assign(std::size_t(layers) + 1, 2);
  size.row_elements[0] = std::size_t(own_rows);
  size.inner_elements = std::size_t(own_rows) - 2;
  size.faces = {{0, Side::lower, 0, 0}, {2, Side::upper, 0, 0}};
  return size;
}

TEST(PartTimes, of_elements_with_pressures_have_two_layers_and_sweeps_a_stage) {
  const StepSweeps plain(4), pressed(4, true);
  const HaloStrategy &deep = *find_halo_strategy("deep"), &each = *find_halo_strategy("overlap"),
                     &split = *find_halo_strategy("deep-overlap");
  EXPECT_EQ(halo_depth(deep, plain), 4);
  EXPECT_EQ(halo_depth(deep, pressed), 8);
  EXPECT_EQ(halo_depth(each, plain), 1);
  EXPECT_EQ(halo_depth(each, pressed), 2);
  // Stages of layers 1, 2, 3, 4: 3, 2, 1, 0; with pressures 3, 3, 2, 2, 1, 1, 0, 0.
  EXPECT_EQ(element_stages(strip(100, 4), deep, plain), 100 * 4 + 2 * 6);
  EXPECT_EQ(element_stages(strip(100, 8), deep, pressed), 100 * 4 + 2 * 12);
  const NodeSpeed unit{"", 1, 1};
  EXPECT_GT(part_times(strip(100, 1), each, plain, 1, unit).inner_s, 0);
  EXPECT_EQ(part_times(strip(100, 2), each, pressed, 1, unit).inner_s, 0);
  // Rows of the upper pass: 4, 6, 8, 10; with pressures 8, 12, 16, 20, from the last stage on.
  EXPECT_DOUBLE_EQ(part_times(strip(100, 4), split, plain, 1, unit).upper_s, 28);
  EXPECT_DOUBLE_EQ(part_times(strip(100, 8), split, pressed, 1, unit).upper_s, 56);
}

TEST(BalanceModel, gives_shares_in_proportion_to_speed) {
  const ModelledBalance model = modelled_balance(plate(2000, 4));
  EXPECT_NEAR(model.fast_share, 0.8, 1.0 / 2000);
  EXPECT_NEAR(model.step_s, (400 + redundant_rows) * 2000 / speed, 2000 / speed);
  EXPECT_GT(model.of_sum, 0.995);
}

TEST(BalanceModel, of_an_equal_split_waits_for_the_slow_one) {
  const ModelledBalance model = modelled_balance(plate(200, 50));
  EXPECT_NEAR(model.equal_split_of_fast, 200 / 50.0 / (100 + redundant_rows),
              1e-12); // the paper's finding: far below 1
  EXPECT_LT(model.equal_split_of_fast, 0.05);
}

TEST(BalanceModel, of_transfers_in_the_open_pays_latency_and_bytes_each_step) {
  ModelledPlate slow_link = plate(100, 1);
  slow_link.link = {2e-4, 1e-9, 0, 0};
  EXPECT_NEAR(modelled_step_s(slow_link, 50),
              (50 + redundant_rows) * 100 / speed + 2e-4 + 4 * 100 * 104 * 1e-9, 1e-12);
}

TEST(BalanceModel, of_overlapped_transfers_hides_what_is_shorter_than_the_rest_of_the_step) {
  ModelledPlate slow_link = plate(100, 1), no_link = plate(100, 1);
  slow_link.link = {2e-4, 1e-9, 0, 0};
  slow_link.is_overlapped = no_link.is_overlapped = true;
  EXPECT_NEAR(modelled_step_s(slow_link, 50), modelled_step_s(no_link, 50), 1e-9);
  slow_link.link.latency_s = 1;
  EXPECT_GT(modelled_step_s(slow_link, 50), 0.4);
}

TEST(BalanceModel, says_where_joining_does_not_pay) {
  ModelledPlate small = plate(50, 50);
  small.fast_speed = 5e8; // a step of 5 us
  small.slow_speed = 1e7;
  small.link = {1e-5, 1 / 12e9, 0, 0};
  EXPECT_LT(modelled_balance(small).of_fast, 1);
  small.rows = 4000;
  EXPECT_GT(modelled_balance(small).of_fast, 1);
}

} // namespace
} // namespace dss::test
