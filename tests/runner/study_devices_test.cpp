/// Studies with the keys `device` and `hybrid`.
#include "experiments/studies/balance/balance_study.hpp"
#include "experiments/studies/speedup/speedup_study.hpp"
#include "solver/error.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace dss {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class StudyOfDevices : public test::OwnDirectory {
protected:
  StudyOfDevices() {
    study = {{"experiment", "devices"},
             {"title", "Devices"},
             {"base", {"scalar"}},
             {"scales", {{"smoke", {{"set", {{"n", 10}}}, {"steps", 10}}}}}};
  }

  std::string written() {
    std::ofstream(directory / "devices.json") << study;
    return (directory / "devices.json").string();
  }
  /// The cells of the block. Those of a base come first.
  std::vector<Cell> cells(const json& block, int cores = 4) {
    study["cells"] = {{{"scene", "plate_paper"}, {"variants", {"scalar"}}}, block};
    SpeedupStudy loaded = read_speedup(open_study(written(), "smoke"), cores);
    loaded.cells.erase(loaded.cells.begin());
    return loaded.cells;
  }
  void expect_refused(const json& block, const std::vector<std::string>& words) {
    try {
      cells(block);
      FAIL() << "accepted: " << block;
    } catch (const InputError& error) {
      for (const std::string& word : words)
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
  json study;
};

TEST_F(StudyOfDevices, ADeviceThatIsNotThereMakesItsCellsUnavailable) {
  for (const json& block :
       {json{{"scene", "plate_paper"}, {"variants", {"opencl"}}, {"device", "no such device"}},
        json{{"scene", "plate_paper"}, {"hybrid", "scalar,opencl@[9:9]"}},
        json{{"scene", "plate_paper"}, {"hybrid", "auto"}, {"device", "no such device"}}}) {
    const std::vector<Cell> found = cells(block);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].is_unavailable) << block;
    EXPECT_STREQ(found[0].skipped_status(), "unavailable");
    EXPECT_NE(found[0].skipped, "");
  }
}

TEST_F(StudyOfDevices, AHybridHasTheThreadsOfItsMembersOnTheCpu) {
  const auto found = cells({{"scene", "plate_paper"},
                            {"hybrid", {"scalar:cores,scalar:1", "scalar:rest,opencl@[9:9]:2"}}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].hybrid, "scalar:4,scalar:1");
  EXPECT_EQ(found[0].variant, "hybrid");
  EXPECT_EQ(found[0].threads, 5);
  EXPECT_TRUE(found[0].is_oversubscribed(4));
  EXPECT_EQ(found[1].hybrid, "scalar:3,opencl@[9:9]:2");
  EXPECT_EQ(found[1].threads, 3);
}

TEST_F(StudyOfDevices, AnAutomaticHybridHasThoseOfTheBlock) {
  const auto found =
      cells({{"scene", "plate_paper"}, {"hybrid", "auto"}, {"threads", {1, "cores"}}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].threads, 4);
  EXPECT_EQ(found[1].label(), "hybrid auto, 4 threads");
}

TEST_F(StudyOfDevices, MembersMayBeProcessesOfTheirOwn) {
  const auto found = cells({{"scene", "plate_paper"},
                            {"hybrid", {"scalar:2,scalar:2"}},
                            {"ranks", {2}},
                            {"halos", {"sendrecv"}}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].threads, 2);
  EXPECT_EQ(found[0].label(), "hybrid scalar:2,scalar:2, 2 ranks, halo sendrecv");
}

TEST_F(StudyOfDevices, WrongKeysAreRefusedWithTheirPlace) {
  const json plate = {{"scene", "plate_paper"}};
  const auto with = [&](json more) {
    more.update(plate);
    return more;
  };
  expect_refused(with({{"variants", {"scalar"}}, {"device", "cpu"}}),
                 {"/cells/1/variants", "scalar", "opencl"});
  expect_refused(with({{"variants", {"scalar"}}, {"hybrid", "auto"}}),
                 {"/cells/1/variants", "hybrid"});
  expect_refused(with({{"hybrid", "scaler,opencl"}}), {"/cells/1/hybrid", "\"scalar\""});
  expect_refused(with({{"hybrid", "scalar:0"}}), {"/cells/1/hybrid", "scalar:0"});
  expect_refused(with({{"hybrid", "scalar"}, {"threads", {2}}}), {"/cells/1/threads", "members"});
  expect_refused(with({{"hybrid", "auto"}, {"ranks", {2}}}), {"/cells/1/ranks", "one process"});
  expect_refused(with({{"variants", {"opencl"}}, {"devices", "cpu"}}), {"/cells/1", "\"device\""});
}

TEST_F(StudyOfDevices, StepsOfAVariantMayBeOfOneSetAlone) {
  study["scales"]["smoke"] = {{"set", {{"n", {10, 12}}}},
                              {"steps", 10},
                              {"full_steps", 1000},
                              {"steps_for", {{"reference", 8}, {"reference n=12", 6}}}};
  const auto found = cells({{"scene", "plate_paper"}, {"variants", {"reference"}}});
  ASSERT_EQ(found.size(), 3u); // including that of n=12 of the base
  EXPECT_EQ(found[0].steps, 10);
  EXPECT_EQ(found[1].steps, 8);
  EXPECT_EQ(found[2].steps, 6);
  EXPECT_EQ(found[2].full_steps, 1000);
}

TEST_F(StudyOfDevices, ABalanceIsAModelWithAStatusOfItsOwn) {
  study = {{"experiment", "b"},
           {"title", "B"},
           {"scales", {{"smoke", json::object()}}},
           {"balance",
            {{"slow_element_steps_per_s", 1e8},
             {"speed_ratios", {1, 50}},
             {"n", {50, 100}},
             {"links", {{{"label", "L"}, {"latency_us", 10}, {"gb_per_s", 12}}}}}}};
  const Table table = balance_table(read_balance(open_study(written(), "smoke")));
  ASSERT_EQ(table.rows.size(), 2u * 2 * 2);
  for (const Record& row : table.rows) {
    EXPECT_EQ(text_in(row, "status"), "modelled");
    EXPECT_EQ(text_in(row, "measured_wall_s"), "");
    EXPECT_EQ(text_in(row, "modelled_joining_pays"),
              number_in(row, "modelled_of_fast") > 1 ? "yes" : "no");
  }
  EXPECT_LT(number_in(table.rows[1], "modelled_equal_split_of_fast"), 0.1); // n = 50, 1:50
  study["balance"]["n"] = {1};
  EXPECT_THROW(read_balance(open_study(written(), "smoke")), InputError);
}

} // namespace
} // namespace dss
