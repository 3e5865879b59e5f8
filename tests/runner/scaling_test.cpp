#include "experiments/measure/cell_bases.hpp"
#include "experiments/measure/compare.hpp"
#include "experiments/studies/speedup/scaling.hpp"
#include "experiments/studies/speedup/speedup_table.hpp"
#include "tests/runner/measured_cells.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

/// avx2 on 1, 2 and 4 ranks of a machine with 2 cores, beside its base and one process of as many
/// threads. All times drift together.
class Scaling : public ::testing::Test {
protected:
  enum Place { scalar, one, two_threads, deep, shared, four, weak };
  Scaling() {
    study.name = "study";
    study.title = "A study";
    study.bases = {"scalar"};
    study.scale.name = "host";
    study.cells = {cell("scalar", 1),
                   cell("avx2", 1),
                   cell("avx2", 2),
                   on_ranks(cell("avx2", 1), 2, "deep"),
                   on_ranks(cell("avx2", 1), 2, "shared"),
                   on_ranks(cell("avx2", 1), 4, "deep"),
                   on_ranks(cell("avx2", 1), 2, "deep")};
    study.cells[one].weak_base_set = study.cells[weak].weak_base_set = "n=10";
    study.cells[weak].set = {{"n", "14"}};
    const double seconds[] = {9, 3.6, 1.9, 2, 2.4, 1.8, 4};
    for (long r = 0; r < 6; ++r)
      for (std::size_t place = 0; place < study.cells.size(); ++place) {
        records.push_back(row(study.cells[place], r, seconds[place] * (1 + 0.1 * double(r))));
        if (place == weak) records.back()["elements"] = "196";
      }
  }
  Record derived(Place place) const { return derive_table(study, records).rows.at(place); }
  double number(Place place, const std::string& column) const {
    return number_in(derived(place), column);
  }
  Record& record(Place place, long repetition) {
    return records.at(std::size_t(repetition) * study.cells.size() + place);
  }
  SpeedupStudy study;
  std::vector<Record> records;
};

TEST(KarpFlatt, IsTheSerialFractionOfAmdahlsLaw) {
  EXPECT_NEAR(karp_flatt(1.8, 2), 1.0 / 9, 1e-15); // (1/1.8 - 1/2) / (1/2)
  EXPECT_NEAR(karp_flatt(4, 4), 0, 1e-15);
  for (const double serial : {0.05, 0.3})
    EXPECT_NEAR(karp_flatt(1 / (serial + (1 - serial) / 6), 6), serial, 1e-14);
}

TEST_F(Scaling, CellsThatDifferInRanksAloneAreComparedByPairs) {
  EXPECT_DOUBLE_EQ(number(deep, "speedup_vs_1_rank"), 1.8);
  EXPECT_DOUBLE_EQ(number(deep, "speedup_vs_1_rank_low"), 1.8);
  EXPECT_DOUBLE_EQ(number(deep, "parallel_efficiency"), 0.9);
  EXPECT_NEAR(number(deep, "karp_flatt"), 1.0 / 9, 1e-14);
  EXPECT_DOUBLE_EQ(number(deep, "speedup_vs_scalar"), 4.5);
  EXPECT_DOUBLE_EQ(number(deep, "speedup_vs_threads"), 0.95);
  EXPECT_DOUBLE_EQ(number(shared, "speedup_vs_1_rank"), 1.5);
}

TEST_F(Scaling, OneRankHasNoScaling) {
  for (const Place place : {scalar, one, two_threads})
    for (const char* column :
         {"speedup_vs_1_rank", "parallel_efficiency", "karp_flatt", "weak_efficiency"})
      EXPECT_EQ(text_in(derived(place), column), "") << column;
}

TEST_F(Scaling, MoreRanksThanCoresAreShownWithoutASpeedUp) {
  const Record crowded = derived(four);
  EXPECT_EQ(text_in(crowded, "status"), "oversubscribed");
  EXPECT_NE(text_in(crowded, "measured_wall_s"), "");
  for (const char* column :
       {"speedup_vs_scalar", "speedup_vs_1_rank", "parallel_efficiency", "karp_flatt"})
    EXPECT_EQ(text_in(crowded, column), "") << column;
  const Record two_each = [&] { // threads count for each rank
    study.cells[deep].threads = 2;
    for (long r = 0; r < 6; ++r) record(deep, r) = row(study.cells[deep], r, 1);
    return derived(deep);
  }();
  EXPECT_EQ(text_in(two_each, "status"), "oversubscribed");
}

TEST_F(Scaling, NoClaimIsMadeOfMoreRanksThanCoresWhenRunsAreCompared) {
  EXPECT_EQ(compare_records(records, records, default_resolution).at(four).verdict,
            "no claim: oversubscribed");
  EXPECT_TRUE(compare_records(records, records, default_resolution)
                  .at(deep)
                  .verdict.starts_with("same within "));
}

TEST_F(Scaling, FewerThanSixPairsGiveNoSpeedUp) {
  std::erase_if(records, [](const Record& record) { return text_in(record, "repetition") == "5"; });
  const Record row = derived(deep);
  EXPECT_NE(text_in(row, "measured_wall_s"), "");
  for (const char* column : {"speedup_vs_scalar", "speedup_vs_1_rank", "speedup_vs_threads"})
    EXPECT_EQ(text_in(row, column), "") << column;
}

/// `auto` that ran as `deep` in 2 s: the cell `deep` takes `seconds`.
TEST_F(Scaling, AutoIsComparedWithTheStrategyThatItChose) {
  study.cells.push_back(on_ranks(cell("avx2", 1), 2, "auto"));
  for (long r = 0; r < 6; ++r) {
    Record ran = row(study.cells.back(), r, 2 * (1 + 0.1 * double(r)));
    ran["halo_used"] = "deep";
    records.push_back(ran);
  }
  Table table = derive_table(study, records);
  EXPECT_DOUBLE_EQ(number_in(table.rows.back(), "auto_vs_chosen"), 1);
  for (Record& each : table.rows) each["resolution"] = "0.02";
  EXPECT_EQ(table_text(study, table).find("Inconsistent"), std::string::npos);
  for (Record& record : records)
    if (text_in(record, "halo_used") == "deep")
      record["wall_s"] = number_text(0.9 * number_in(record, "wall_s"));
  table = derive_table(study, records);
  for (Record& each : table.rows) each["resolution"] = "0.02";
  EXPECT_NEAR(number_in(table.rows.back(), "auto_vs_chosen"), 1 / 0.9, 1e-12);
  EXPECT_NE(table_text(study, table).find("Inconsistent: avx2, 2 ranks x 1 thread, halo auto"),
            std::string::npos);
}

TEST_F(Scaling, AScaledTimeIsComparedWithOneRunOfAllSteps) {
  Cell& short_run = study.cells[scalar];
  const long steps = short_run.steps;
  short_run.full_steps = 10 * steps;
  Cell whole = short_run;
  whole.steps = whole.full_steps;
  whole.is_whole_once = true;
  study.cells.push_back(whole);
  const double scaled = number(scalar, "extrapolated_wall_s");
  records.push_back(row(whole, 0, scaled / 1.03));
  EXPECT_NEAR(number(scalar, "scaling_error"), 0.03, 1e-12);
  const Record once = derive_table(study, records).rows.back();
  EXPECT_EQ(text_in(once, "scaling_error"), "");
  EXPECT_EQ(text_in(once, "status"), "once");
}

TEST_F(Scaling, AFailedRankCostsTheCellItsScaling) {
  Record failed = record(deep, 5);
  failed["repetition"] = "6";
  failed["wall_s"] = "";
  failed["status"] = "failed";
  records.push_back(failed);
  EXPECT_EQ(text_in(derived(deep), "speedup_vs_1_rank"), "");
  EXPECT_EQ(text_in(derived(deep), "status"), "failed");
}

TEST_F(Scaling, WeakEfficiencyIsElementStepsOfARankAgainstThoseOfOneRankAlone) {
  // 98 elements a rank instead of 100, 4 s instead of 3.6 s
  EXPECT_NEAR(number(weak, "weak_efficiency"), 0.98 * 3.6 / 4, 1e-14);
  EXPECT_NEAR(number(weak, "weak_efficiency_high"), 0.98 * 3.6 / 4, 1e-14);
  EXPECT_EQ(text_in(derived(weak), "weak_base_set"), "n=10");
  EXPECT_EQ(text_in(derived(weak), "speedup_vs_1_rank"),
            ""); // the larger problem has no cell on 1 rank
  EXPECT_EQ(text_in(derived(deep), "weak_efficiency"), "");
}

TEST_F(Scaling, BitsMustNotDependOnRanksOrHalos) {
  EXPECT_EQ(text_in(derived(deep), "status"), "ok");
  record(shared, 3)["state_digest"] = "0100";
  for (const Place place : {one, two_threads, deep, shared, four}) {
    EXPECT_EQ(text_in(derived(place), "status"), "wrong");
    EXPECT_EQ(text_in(derived(place), "speedup_vs_1_rank"), "");
  }
  EXPECT_EQ(text_in(derived(scalar), "status"), "ok");
  EXPECT_EQ(text_in(derived(weak), "status"), "ok"); // because its problem is another one
}

TEST_F(Scaling, BasesOfAnyScalingGoOnWithTheirPartners) {
  EXPECT_TRUE(is_scaling_base(study, study.cells[one]));
  EXPECT_TRUE(is_scaling_base(study, study.cells[two_threads]));
  for (const Place place : {scalar, deep, four, weak})
    EXPECT_FALSE(is_scaling_base(study, study.cells[place]));
}

TEST_F(Scaling, TheTableForPeopleShowsRanksAndWhatTheyExchange) {
  for (long r = 0; r < 6; ++r) {
    record(deep, r)["halo_used"] = r == 0 ? "shared" : "deep";
    record(deep, r)["communication_share"] = r == 0 ? "0.9" : "0.25";
    record(deep, r)["messages_per_step"] = "2";
  }
  const Table table = derive_table(study, records);
  EXPECT_EQ(text_in(table.rows.at(deep), "halo_used"), "deep or shared");
  EXPECT_DOUBLE_EQ(number_in(table.rows.at(deep), "communication_share"), 0.25);
  const std::string text = table_text(study, table);
  for (const char* words :
       {"Over ranks", "avx2, 2 ranks x 1 thread, halo deep", "1.80 [1.80, 1.80]", "25.0 %"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

} // namespace
} // namespace dss
