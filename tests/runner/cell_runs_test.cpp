/// Repetitions that other programs disturb are repeated, and the effort for that is limited.
#include "experiments/measure/cell_runs.hpp"
#include "experiments/measure/samples.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "tests/runner/measured_cells.hpp"

#include <fstream>
#include <gtest/gtest.h>

namespace dss {
namespace {

class NoChecks : public CellChecks {
public:
  std::vector<std::string> options(const Cell&, long) override { return {}; }
};

/// A study of one cell, whose runs are a script: its first `disturbed` runs are contaminated.
class DisturbedRuns : public test::OwnDirectory {
protected:
  DisturbedRuns() {
    study.name = "study";
    study.path = file("study.json");
    std::ofstream(study.path) << "{}";
    study.scale.name = "host";
    study.scale.min_repetitions = study.scale.max_repetitions = 2;
    study.scale.patience_s = 10;
    study.cells = {cell("scalar", 1)};
  }
  CellSample measured(int disturbed, long rounds = 0, bool resume = false) {
    const std::string script = file("program");
    std::ofstream(script) << "#!/bin/sh\ncd " << directory.string() << "\n"
                          << "echo run >> runs\n"
                          << "if [ $(wc -l < runs) -le " << disturbed
                          << " ]; then dirty=true; else dirty=false; fi\n"
                          << "echo '{\"wall_s\": 1, \"steps\": 100, \"status\": \"ok\", "
                             "\"check\": \"passed\", \"is_contaminated\": '$dirty'}'\n";
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    NoChecks checks;
    Progress progress;
    const StudyPaths paths = study_paths(directory.string(), study.name);
    records = run_cells(study, paths, resume, script, checks, rounds, progress);
    std::ifstream stream(paths.context);
    context.assign(std::istreambuf_iterator<char>(stream), {});
    return samples_of(records).at(0);
  }
  CellStudy study;
  std::vector<Record> records;
  std::string context;
};

TEST_F(DisturbedRuns, AreRepeatedUntilTheyAreCleanAndTheStudySaysHowOften) {
  const CellSample sample = measured(3);
  EXPECT_EQ(sample.repetitions.size(), 2u);
  EXPECT_EQ(sample.contaminated, 0);
  EXPECT_EQ(records.size(), 2u + 3) << "all attempts are recorded";
  EXPECT_NE(context.find("repeated 3 disturbed repetitions"), std::string::npos) << context;
}

TEST_F(DisturbedRuns, RoundsCanBeSpreadOverSeveralRunsOfTheStudy) {
  EXPECT_EQ(measured(0, 1).repetitions.size(), 1u);
  EXPECT_EQ(measured(0, 1, true).repetitions.size(), 2u);
  EXPECT_EQ(records.size(), 2u);
}

TEST_F(DisturbedRuns, AreRepeatedAtMostAsOftenAsTheStudySays) {
  study.scale.retries = 2;
  const CellSample sample = measured(100);
  EXPECT_EQ(sample.contaminated, 2);
  EXPECT_EQ(records.size(), 2u * (1 + 2));
}

TEST_F(DisturbedRuns, AreNotRepeatedWithoutPatience) {
  study.scale.patience_s = 0;
  const CellSample sample = measured(100);
  EXPECT_EQ(sample.contaminated, 2);
  EXPECT_EQ(records.size(), 2u);
}

TEST_F(DisturbedRuns, ThatShareCoresAreNotRepeated) {
  study.cells[0].ranks = 100000;
  const CellSample sample = measured(100);
  EXPECT_EQ(records.size(), 1u);
  EXPECT_EQ(sample.contaminated, 1);
}

/// The budget limits the repetitions beyond the least number, without which there is no interval.
TEST_F(DisturbedRuns, TheLeastNumberOfRepetitionsIsRunWhateverTheBudget) {
  study.scale.budget_s = 1e-9;
  study.scale.max_repetitions = 5;
  EXPECT_EQ(measured(0).repetitions.size(), 2u);
}

} // namespace
} // namespace dss
