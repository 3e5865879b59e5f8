/// Cells on devices and hybrids: what the study reads, and the columns of their costs.
#include "experiments/measure/cell_record.hpp"
#include "experiments/measure/oracle_checks.hpp"
#include "experiments/run/timed/run_fields.hpp"
#include "experiments/run/timed/run_record.hpp"
#include "experiments/studies/speedup/device_columns.hpp"
#include "experiments/studies/speedup/speedup_table.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "tests/runner/measured_cells.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace dss {
namespace {

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
class DeviceTables : public test::OwnDirectory {
protected:
  DeviceTables() {
    study.name = "study";
    study.title = "A study";
    study.bases = {"avx512"};
    study.scale.name = "host";
    study.cells = {cell("avx512", 1), on("cpu", cell("opencl", 1)),
                   on("cpu", cell("opencl-rhs", 1, 50)), hybrid("avx512:1,opencl@cpu:1", 2),
                   on("gpu", cell("opencl", 1))};
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
  SpeedupStudy study;
  std::vector<Record> records;
};

TEST_F(DeviceTables, TheKeyNamesDeviceAndMembersOfThoseThatHaveSome) {
  EXPECT_EQ(study.cells[0].key(), "plate_paper n=10 avx512 t1 spatial f64 rk4 100 steps");
  EXPECT_EQ(study.cells[1].key(), "plate_paper n=10 opencl@cpu t1 spatial f64 rk4 100 steps");
  EXPECT_EQ(study.cells[1].label(), "opencl on cpu, 1 thread");
  EXPECT_EQ(study.cells[3].key(),
            "plate_paper n=10 hybrid[avx512:1,opencl@cpu:1] t2 spatial f64 rk4 100 steps");
  EXPECT_EQ(study.cells[3].label(), "hybrid avx512:1,opencl@cpu:1");
  EXPECT_EQ(study.cells[3].problem_key(), study.cells[0].problem_key());
}

TEST_F(DeviceTables, TheRunGetsTheDeviceOrTheMembers) {
  const auto on_device = run_arguments(study, study.cells[1], {});
  EXPECT_TRUE(contains(on_device, "--device") && contains(on_device, "cpu"));
  const auto joined = run_arguments(study, on("cpu", study.cells[3]), {});
  EXPECT_TRUE(contains(joined, "--hybrid") && contains(joined, "avx512:1,opencl@cpu:1"));
  EXPECT_FALSE(contains(joined, "--device")); // the members name their devices
}

TEST_F(DeviceTables, EndsAreCheckedInSoManyRepetitions) {
  OracleChecks checks(study, directory.string(), false, [](const std::string&) {});
  const Cell& one = study.cells[1];
  EXPECT_FALSE(contains(checks.options(one, 5), "--check-tail"));
  study.scale.tail_checks = 1;
  EXPECT_FALSE(contains(checks.options(one, 0), "--check-tail"));
  EXPECT_TRUE(contains(checks.options(one, 1), "--check-tail"));
}

TEST_F(DeviceTables, TransfersEveryStageAreComparedWithTheResidentState) {
  EXPECT_DOUBLE_EQ(number_in(derived(2), "speedup_vs_resident"),
                   0.25); // by step: the cell makes half as many
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
  records.push_back(
      failure_record({study, study.cells[4], 0, 0, 2}, study.cells[4].skipped_status(), "no GPU"));
  const Record absent = derived(4);
  EXPECT_EQ(absent.at("status"), "unavailable");
  EXPECT_EQ(absent.at("reason"), "no GPU");
  for (const char* column :
       {"measured_wall_s", "element_steps_per_s", "launches_per_step", "bandwidth_share"})
    EXPECT_EQ(text_in(absent, column), "") << column;
}

TEST_F(DeviceTables, SharesOfTheBandwidthCountTheStateOnceInAndOnceOut) {
  // 100 elements x 100 steps in a median of 6.25 s, 2 x 104 bytes each, of 416 kB/s
  EXPECT_DOUBLE_EQ(number_in(derived(1), "bandwidth_share"), 100 * 100 / 6.25 * 208 / 416000);
  EXPECT_DOUBLE_EQ(state_bytes("spatial", "f32"), 52);
  EXPECT_DOUBLE_EQ(state_bytes("membrane", "f64"), 48);
  EXPECT_EQ(derived(0)["bandwidth_share"], "");
}

TEST_F(DeviceTables, TheCompilationShownIsTheLongest) {
  EXPECT_EQ(number_in(derived(1), "build_s"), 2.5);
}

/// The record of a run, as its process says it and the study reads it.
class DeviceRecord : public DeviceTables {
protected:
  Record recorded(const RunResult& result) const {
    const nlohmann::json said = nlohmann::json::parse(run_json({}, result).dump());
    return result_record({study, study.cells[1], 0, 0, 2}, said, 1.5);
  }
};

TEST_F(DeviceRecord, TransfersAndLaunchesAreGivenByStep) {
  RunResult result;
  result.steps = 10;
  result.device_use.device.id = "0:0";
  result.device_use.device.name = "P";
  result.device_use.launches = 40;
  result.device_use.to_device_bytes = 1000;
  result.device_use.from_device_bytes = 500;
  result.device_use.transfer_s = 1e-3;
  result.device_use.launch_s = 5e-6;
  const Record row = recorded(result);
  EXPECT_EQ(row.at("device_used"), "0:0 P");
  EXPECT_DOUBLE_EQ(number_in(row, "launches_per_step"), 4);
  EXPECT_DOUBLE_EQ(number_in(row, "to_device_bytes_per_step"), 100);
  EXPECT_DOUBLE_EQ(number_in(row, "from_device_bytes_per_step"), 50);
  EXPECT_DOUBLE_EQ(number_in(row, "transfer_us_per_step"), 100);
  EXPECT_DOUBLE_EQ(number_in(row, "launch_us"), 5);
  EXPECT_EQ(text_in(row, "members"), "");
}

TEST_F(DeviceRecord, OfAHybridTheMembersAndTheirSharesAreThose) {
  RunResult result;
  result.hybrid.members = {{"avx512:1", 1e6, 0.75, 1e-3}, {"b", 1e6, 0.25, 1e-3}};
  result.hybrid.rebalances = 2;
  result.hybrid.reason = "asked";
  const Record row = recorded(result);
  EXPECT_EQ(row.at("members"), "avx512:1 0.750; b 0.250");
  EXPECT_EQ(row.at("rebalances"), "2");
  EXPECT_EQ(text_in(row, "device_used"), "");
}

TEST_F(DeviceRecord, EveryFieldHasAColumnOfItsOwnAndAMeaning) {
  std::set<std::string> keys, columns;
  for (const RunField& field : run_fields()) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    if (*field.column != '\0') {
      EXPECT_TRUE(columns.insert(field.column).second) << field.column;
    }
    EXPECT_STRNE(field.meaning, "") << field.key;
    if (field.in_tables != Aggregate::none) {
      EXPECT_STRNE(field.column, "") << field.key;
    }
  }
  const std::vector<std::string>& raw = raw_columns();
  EXPECT_EQ(std::set<std::string>(raw.begin(), raw.end()).size(), raw.size());
}

TEST(Csv, ColumnsThatAreEmptyInEveryRowAreLeftOut) {
  const Table table{{"a", "b", "c"}, {{{"a", "1"}, {"b", ""}}, {{"c", "2"}}}};
  EXPECT_EQ(without_empty_columns(table).columns, (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(without_empty_columns({{"a"}, {}}).columns, std::vector<std::string>{"a"});
}

TEST(Csv, NumbersAreWrittenInTheShortestFormThatReadsBackTheSame) {
  EXPECT_EQ(number_text(0.255744296), "0.255744296");
  EXPECT_EQ(number_text(1e-7), "1e-07");
  EXPECT_EQ(number_text(100), "100");
  EXPECT_EQ(number_text(std::nan("")), "");
  for (const double value : {0.1, 1.0 / 3, 1e300, 5e-324})
    EXPECT_EQ(number_in({{"x", number_text(value)}}, "x"), value);
}

} // namespace
} // namespace dss
