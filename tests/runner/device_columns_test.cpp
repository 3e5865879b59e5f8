/// Cells on devices and hybrids: what the study says of them, and what the table says of their costs.
#include "experiments/runner/cell_record.hpp"
#include "experiments/runner/device_columns.hpp"
#include "experiments/runner/tables.hpp"
#include "tests/runner/measured_cells.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace dss {
namespace {

using nlohmann::json;

Cell on(const std::string& device, Cell of) {
  of.device = device;
  return of;
}

Cell hybrid(const std::string& members, int threads) {
  Cell result = cell("hybrid", threads);
  result.hybrid = members;
  return result;
}

bool contains(const std::vector<std::string>& line, const std::string& word) {
  return std::find(line.begin(), line.end(), word) != line.end();
}

/// avx512 takes 4 s, opencl 5 s, its right-hand side alone 20 s, both joined 2.5 s.
class DeviceTables : public ::testing::Test {
protected:
  DeviceTables() {
    study.name = "study";
    study.title = "A study";
    study.bases = {"avx512"};
    study.scale.name = "host";
    study.cells = {cell("avx512", 1), on("cpu", cell("opencl", 1)), on("cpu", cell("opencl-rhs", 1, 50)),
                   hybrid("avx512:1,opencl@cpu:1", 2), on("gpu", cell("opencl", 1))};
    const double wall_s[] = {4, 5, 10, 2.5};
    for (long r = 0; r < 6; ++r)
      for (std::size_t c = 0; c < 4; ++c) {
        records.push_back(row(study.cells[c], r, wall_s[c] * (1 + 0.1 * double(r))));
        records.back()["has_fma"] = "true";
        if (c == 1 || c == 2) records.back()["triad_bytes_per_s"] = "416000";
        if (c == 1 || c == 2) records.back()["build_s"] = r == 0 ? "2.5" : "0.1";
      }
  }
  Record derived(std::size_t place) const { return derive_table(study, records).rows.at(place); }
  Study study;
  std::vector<Record> records;
};

TEST_F(DeviceTables, TheKeyNamesDeviceAndMembersOfThoseThatHaveSome) {
  EXPECT_EQ(study.cells[0].key(), "plate_paper n=10 avx512 t1 spatial f64 rk4 100 steps");
  EXPECT_EQ(study.cells[1].key(), "plate_paper n=10 opencl@cpu t1 spatial f64 rk4 100 steps");
  EXPECT_EQ(study.cells[1].label(), "opencl on cpu, 1 thread");
  EXPECT_EQ(study.cells[3].key(), "plate_paper n=10 hybrid[avx512:1,opencl@cpu:1] t2 spatial f64 rk4 100 steps");
  EXPECT_EQ(study.cells[3].label(), "hybrid avx512:1,opencl@cpu:1");
  EXPECT_EQ(study.cells[3].problem_key(), study.cells[0].problem_key());
}

TEST_F(DeviceTables, TheRunGetsTheDeviceOrTheMembers) {
  const auto on_device = run_arguments(study, study.cells[1], "o.state");
  EXPECT_TRUE(contains(on_device, "--device") && contains(on_device, "cpu"));
  const auto joined = run_arguments(study, on("cpu", study.cells[3]), "o.state");
  EXPECT_TRUE(contains(joined, "--hybrid") && contains(joined, "avx512:1,opencl@cpu:1"));
  EXPECT_FALSE(contains(joined, "--device")); // the members name theirs
}

TEST_F(DeviceTables, EndsAreCheckedInSoManyRepetitions) {
  EXPECT_FALSE(contains(run_arguments(study, study.cells[1], "o.state", 5), "--check-tail"));
  study.scale.tail_checks = 1;
  EXPECT_FALSE(contains(run_arguments(study, study.cells[1], "o.state", 0), "--check-tail"));
  EXPECT_TRUE(contains(run_arguments(study, study.cells[1], "o.state", 1), "--check-tail"));
}

TEST_F(DeviceTables, TransfersEveryStageAreComparedWithTheResidentState) {
  EXPECT_DOUBLE_EQ(number_in(derived(2), "speedup_vs_resident"), 0.25); // by step: it makes half as many
  EXPECT_EQ(derived(1)["speedup_vs_resident"], "");
}

TEST_F(DeviceTables, AHybridIsComparedWithTheFastestAloneAndTheSumOfItsMembers) {
  const Record joined = derived(3);
  EXPECT_EQ(joined.at("fastest_alone"), "avx512, 1 thread");
  EXPECT_DOUBLE_EQ(number_in(joined, "speedup_vs_fastest_alone"), 1.6);
  EXPECT_NEAR(number_in(joined, "of_sum_of_members"), (1 / 2.5) / (1 / 4.0 + 1 / 5.0), 1e-12);
}

TEST_F(DeviceTables, TheFastestVariantIsAMemberUnderItsOwnName) {
  study.cells[3] = hybrid("auto:1,opencl@cpu:1", 2);
  for (Record& record : records)
    if (text_in(record, "cell").find("hybrid") != std::string::npos) {
      record["cell"] = study.cells[3].key();
      record["members"] = "avx512:1 0.550; opencl@cpu:1 0.450";
    }
  EXPECT_NEAR(number_in(derived(3), "of_sum_of_members"), (1 / 2.5) / (1 / 4.0 + 1 / 5.0), 1e-12);
}

TEST_F(DeviceTables, ACellWithoutItsDeviceHasAStatusAndNoFigure) {
  study.cells[4].skipped = "--device gpu: no such device";
  study.cells[4].is_unavailable = true;
  records.push_back(failure_record({study, study.cells[4], 0, 0, 2}, study.cells[4].skipped_status(), "no GPU"));
  const Record absent = derived(4);
  EXPECT_EQ(absent.at("status"), "unavailable");
  EXPECT_EQ(absent.at("reason"), "no GPU");
  for (const char* column : {"measured_wall_s", "element_steps_per_s", "launches_per_step", "bandwidth_share"})
    EXPECT_EQ(text_in(absent, column), "") << column;
}

TEST_F(DeviceTables, SharesOfTheBandwidthCountTheStateOnceInAndOnceOut) {
  // 100 elements x 100 steps in a median of 6.25 s, 2 x 104 bytes each, of 416 kB/s
  EXPECT_DOUBLE_EQ(number_in(derived(1), "bandwidth_share"), 100 * 100 / 6.25 * 208 / 416000);
  EXPECT_DOUBLE_EQ(state_bytes("spatial", "f32"), 52);
  EXPECT_DOUBLE_EQ(state_bytes("membrane", "f64"), 48);
  EXPECT_EQ(derived(0)["bandwidth_share"], "");
}

TEST_F(DeviceTables, TheCompilationShownIsTheLongest) { EXPECT_EQ(number_in(derived(1), "build_s"), 2.5); }

TEST(DeviceRecord, TransfersAndLaunchesAreGivenByStep) {
  Record row;
  put_device_record(json{{"steps", 10},
                         {"device", {{"id", "0:0"}, {"name", "P"}}},
                         {"launches", 40.0},
                         {"to_device_bytes", 1000.0},
                         {"from_device_bytes", 500.0},
                         {"transfer_s", 1e-3},
                         {"launch_s", 5e-6},
                         {"hybrid", nullptr}},
                    row);
  EXPECT_EQ(row["device_used"], "0:0 P");
  EXPECT_DOUBLE_EQ(number_in(row, "launches_per_step"), 4);
  EXPECT_DOUBLE_EQ(number_in(row, "to_device_bytes_per_step"), 100);
  EXPECT_DOUBLE_EQ(number_in(row, "from_device_bytes_per_step"), 50);
  EXPECT_DOUBLE_EQ(number_in(row, "transfer_us_per_step"), 100);
  EXPECT_DOUBLE_EQ(number_in(row, "launch_us"), 5);
  EXPECT_EQ(text_in(row, "members"), "");
}

TEST(DeviceRecord, OfAHybridTheMembersAndTheirSharesAreThose) {
  Record row;
  put_device_record(json{{"device", nullptr},
                         {"hybrid",
                          {{"members", {{{"member", "avx512:1"}, {"share", 0.75}}, {{"member", "b"}, {"share", 0.25}}}},
                           {"rebalances", 2},
                           {"reason", "asked"}}}},
                    row);
  EXPECT_EQ(row["members"], "avx512:1 0.750; b 0.250");
  EXPECT_EQ(row["rebalances"], "2");
  EXPECT_EQ(text_in(row, "device_used"), "");
}

} // namespace
} // namespace dss
