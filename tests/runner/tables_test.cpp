#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/compare.hpp"
#include "experiments/measure/samples.hpp"
#include "experiments/studies/speedup/speedup_table.hpp"
#include "tests/runner/measured_cells.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace dss {
namespace {

/// Two variants and a twin, six repetitions. The base takes 10 s and drifts. The other takes a
/// quarter of the base's time in each repetition.
class Tables : public ::testing::Test {
protected:
  Tables() {
    study.name = "study";
    study.title = "A study";
    study.bases = {"scalar"};
    study.scale.name = "host";
    study.cells = {cell("scalar", 1), cell("avx2", 1), cell("avx2", 4),
                   cell("scalar", 1, 100, true)};
    for (long r = 0; r < 6; ++r) {
      const double drift = 1 + 0.1 * double(r);
      records.push_back(row(study.cells[0], r, 10 * drift));
      records.push_back(row(study.cells[1], r, 2.5 * drift));
      records.push_back(row(study.cells[2], r, 1 * drift));
      records.push_back(row(study.cells[3], r, 10 * drift * (r % 2 == 0 ? 1.03 : 0.99)));
    }
  }
  Record derived(std::size_t place) const { return derive_table(study, records).rows.at(place); }
  SpeedupStudy study;
  std::vector<Record> records;
};

TEST_F(Tables, SpeedUpsComparePairsOfTheSameRepetitionSoThatDriftCancels) {
  EXPECT_DOUBLE_EQ(number_in(derived(1), "speedup_vs_scalar"), 4);
  EXPECT_DOUBLE_EQ(number_in(derived(1), "speedup_vs_scalar_low"), 4);
  EXPECT_DOUBLE_EQ(number_in(derived(1), "speedup_vs_scalar_high"), 4);
  EXPECT_EQ(derived(1)["converged"], "no"); // because the times drift
}

TEST_F(Tables, MoreThreadsThanCoresAreShownWithoutASpeedUp) {
  EXPECT_EQ(derived(2)["status"], "oversubscribed");
  EXPECT_EQ(derived(2)["speedup_vs_scalar"], "");
  EXPECT_DOUBLE_EQ(number_in(derived(2), "measured_wall_s"), 1.25);
}

TEST_F(Tables, TheTwinGivesTheResolution) {
  EXPECT_NEAR(number_in(derived(0), "resolution"), 0.03, 0.002);
}

TEST_F(Tables, AWrongRepetitionKeepsItsTimeAndCostsTheSpeedUp) {
  records[1]["check"] = "failed";
  EXPECT_EQ(derived(1)["check"], "failed");
  EXPECT_EQ(derived(1)["speedup_vs_scalar"], "");
  EXPECT_NE(derived(1)["measured_wall_s"], "");
}

TEST_F(Tables, UnequalBitsOfVariantsWithFmaCostAllOfThemTheSpeedUp) {
  records[2]["state_digest"] = "0100";
  for (const std::size_t place : {std::size_t(1), std::size_t(2)}) {
    EXPECT_EQ(derived(place)["status"], "wrong");
    EXPECT_EQ(derived(place)["speedup_vs_scalar"], "");
  }
  EXPECT_EQ(derived(0)["status"], "ok");
}

TEST_F(Tables, OneWrongRepetitionMakesTheCellWrongWithItsReason) {
  const auto first = std::ranges::find_if(
      records, [&](const Record& record) { return record.at("cell") == study.cells[1].key(); });
  (*first)["check"] = "failed";
  (*first)["status"] = "wrong";
  (*first)["reason"] = "error 0.5 exceeds the tolerance";
  EXPECT_EQ(derived(1)["status"], "wrong");
  EXPECT_EQ(derived(1)["reason"], "error 0.5 exceeds the tolerance");
  EXPECT_EQ(derived(1)["speedup_vs_scalar"], "");
  EXPECT_FALSE(is_without_failures(derive_table(study, records)));
}

TEST_F(Tables, FewerStepsAreExtrapolatedInColumnsOfTheirOwn) {
  study.cells.push_back(cell("avx512", 1, 10));
  for (long r = 0; r < 6; ++r)
    records.push_back(row(study.cells[4], r, 0.1 * (1 + 0.1 * double(r))));
  EXPECT_DOUBLE_EQ(number_in(derived(4), "extrapolated_wall_s"), 1.25);
  EXPECT_DOUBLE_EQ(number_in(derived(4), "measured_wall_s"), 0.125);
  EXPECT_EQ(derived(4)["speedup_vs_scalar"], "");
  EXPECT_DOUBLE_EQ(number_in(derived(4), "extrapolated_speedup_vs_scalar"), 10);
}

TEST_F(Tables, PublishedFiguresAreInRowsAndColumnsOfTheirOwn) {
  study.paper = {{"one process", 743.14, 7.07}};
  const Record paper = derived(4);
  EXPECT_EQ(paper.at("source"), "paper");
  EXPECT_DOUBLE_EQ(number_in(paper, "paper_wall_s"), 743.14);
  EXPECT_EQ(text_in(paper, "measured_wall_s"), "");
  EXPECT_EQ(text_in(paper, "speedup_vs_scalar"), "");
}

TEST_F(Tables, OfARetriedRepetitionTheLastAttemptCounts) {
  records.push_back(row(study.cells[1], 0, 5));
  EXPECT_EQ(samples_of(records)[1].repetitions.at(0).at("wall_s"), "5");
}

TEST_F(Tables, ARunThatGotSlowerIsSlowerAndAnEqualOneIsTheSame) {
  std::vector<Record> slower = records;
  for (Record& record : slower)
    if (record["cell"] == study.cells[1].key())
      record["wall_s"] = number_text(2 * number_in(record, "wall_s"));
  const auto verdict = [&](const std::vector<Record>& before, const std::vector<Record>& after) {
    return compare_records(before, after, default_resolution).at(1).verdict;
  };
  EXPECT_EQ(verdict(records, slower), "slower");
  EXPECT_EQ(verdict(slower, records), "faster");
  EXPECT_TRUE(verdict(records, records).starts_with("same within "));
}

TEST_F(Tables, ATimeOfAWrongStateIsNoClaimOnEitherSide) {
  std::vector<Record> wrong = records;
  wrong[1]["check"] = "failed";
  wrong[1]["status"] = "wrong";
  const Comparison in_new = compare_records(records, wrong, default_resolution).at(1);
  EXPECT_EQ(in_new.verdict, "no claim: wrong");
  EXPECT_FALSE(in_new.ratio);
  EXPECT_TRUE(in_new.is_new_wrong);
  const Comparison in_old = compare_records(wrong, records, default_resolution).at(1);
  EXPECT_EQ(in_old.verdict, "no claim: wrong");
  EXPECT_FALSE(in_old.is_new_wrong);
  EXPECT_TRUE(compare_records(records, wrong, default_resolution)
                  .at(0)
                  .verdict.starts_with("same within "));
}

TEST_F(Tables, AnUncheckedTimeIsNoClaim) {
  std::vector<Record> unchecked = records;
  unchecked[1]["check"] = "none";
  const Comparison comparison = compare_records(records, unchecked, default_resolution).at(1);
  EXPECT_EQ(comparison.verdict, "no claim: check none");
  EXPECT_FALSE(comparison.is_new_wrong);
}

TEST_F(Tables, ShortRepetitionsAreCountedAndShown) {
  EXPECT_EQ(derived(1)["short"], "0");
  records[1]["wall_s"] = "0.09";
  EXPECT_EQ(derived(1)["short"], "1");
  EXPECT_NE(table_text(study, derive_table(study, records)).find("short samples"),
            std::string::npos);
}

TEST_F(Tables, FewRepetitionsGiveNoVerdict) {
  const std::vector<Record> few(records.begin(), records.begin() + 8);
  EXPECT_EQ(compare_records(few, records, default_resolution).at(0).verdict, "too few repetitions");
}

} // namespace
} // namespace dss
