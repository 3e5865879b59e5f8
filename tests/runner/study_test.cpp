#include "experiments/measure/cell_record.hpp"
#include "experiments/studies/speedup/speedup_study.hpp"
#include "solver/error.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace dss {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Studies in a directory of their own, with a variant that can compute parts.
class StudyOfRanks : public test::OwnDirectory {
protected:
  StudyOfRanks() {
    for (const VariantStatus& status : variants())
      if (status.name != "reference" && !status.is_by_name) variant = status.name;
    block = {{"scene", "plate_paper"}, {"variants", {variant}}};
    study = {{"experiment", "ranks"},
             {"title", "Ranks"},
             {"base", {variant}},
             {"scales", {{"smoke", {{"set", {{"n", 10}}}, {"steps", 10}}}}}};
  }

  SpeedupStudy load(const std::vector<json>& blocks, int cores = 2) {
    study["cells"] = blocks;
    std::ofstream(directory / "ranks.json") << study;
    return read_speedup(open_study((directory / "ranks.json").string(), "smoke"), cores);
  }
  json with(const json& changes) const {
    json changed = block;
    changed.update(changes);
    return changed;
  }
  void expect_refused(const json& changes, const std::vector<std::string>& words) {
    try {
      load({with(changes)});
      FAIL() << "accepted: " << changes;
    } catch (const InputError& error) {
      for (const std::string& word : words)
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
  std::string variant;
  json block, study;
};

bool contains(const std::vector<std::string>& line, const std::string& word) {
  return std::find(line.begin(), line.end(), word) != line.end();
}

TEST_F(StudyOfRanks, WithoutTheKeysEveryCellIsOneProcess) {
  const SpeedupStudy loaded = load({block});
  ASSERT_EQ(loaded.cells.size(), 1u);
  EXPECT_EQ(loaded.cells[0].ranks, 1);
  EXPECT_EQ(loaded.cells[0].key(), "plate_paper n=10 " + variant + " t1 spatial f64 rk4 10 steps");
  EXPECT_EQ(loaded.cells[0].label(), variant + ", 1 thread");
  EXPECT_FALSE(contains(run_arguments(loaded, loaded.cells[0], {}), "--ranks"));
}

TEST_F(StudyOfRanks, BlocksAreLeftOutOfScales) {
  study["scales"]["large"] = {{"set", {{"n", 40}}}, {"steps", 10}};
  EXPECT_EQ(load({block, with({{"threads", 2}, {"not_at", "smoke"}})}).cells.size(), 1u);
  EXPECT_EQ(load({with({{"not_at", "large"}})}).cells.size(), 1u);
  expect_refused({{"not_at", {"large", "smoke"}}},
                 {"/cells:", "every block is \"not_at\" the scale \"smoke\""});
  expect_refused({{"not_at", "smke"}}, {"/cells/0/not_at", "smke", "\"smoke\""});
}

TEST_F(StudyOfRanks, HalosAndDecompositionsMultiplyCellsOnSeveralRanksAlone) {
  const SpeedupStudy loaded = load({with({{"ranks", {1, 2, "cores", 4}},
                                          {"halos", {"deep", "auto"}},
                                          {"decompositions", {"strips", "blocks"}}})});
  ASSERT_EQ(loaded.cells.size(), 1u + 2 * 2 * 2);
  const Cell& last = loaded.cells.back();
  EXPECT_EQ(last.key(),
            "plate_paper n=10 " + variant + " r4 blocks auto t1 spatial f64 rk4 10 steps");
  EXPECT_EQ(last.label(), variant + ", 4 ranks x 1 thread, halo auto, blocks");
  EXPECT_EQ(last.problem_key(), loaded.cells[0].problem_key());
  EXPECT_TRUE(last.is_oversubscribed(2));
  EXPECT_FALSE(loaded.cells[1].is_oversubscribed(2));
  const std::vector<std::string> line = run_arguments(loaded, last, {});
  for (const char* word : {"--ranks", "4", "--halo", "auto", "--decomposition", "blocks"})
    EXPECT_TRUE(contains(line, word)) << word;
}

TEST_F(StudyOfRanks, CoresAreThoseOfTheMachine) {
  const SpeedupStudy loaded = load({with({{"ranks", "1..cores"}})}, 3);
  ASSERT_EQ(loaded.cells.size(), 3u);
  EXPECT_EQ(loaded.cells[2].ranks, 3);
}

TEST_F(StudyOfRanks, FillTakesAsManyThreadsAsFillTheCoresWithTheRanks) {
  const SpeedupStudy loaded =
      load({with({{"ranks", {1, 2, 5, 16, 32}}, {"threads", {"fill"}}})}, 16);
  ASSERT_EQ(loaded.cells.size(), 5u);
  const int threads[] = {16, 8, 3, 1, 1};
  for (std::size_t n = 0; n < 5; ++n) EXPECT_EQ(loaded.cells[n].threads, threads[n]);
  // 8 threads stand twice, once as a number
  EXPECT_EQ(load({with({{"ranks", {2}}, {"threads", {8, "fill"}}})}, 16).cells.size(), 1u);
}

TEST_F(StudyOfRanks, SlowVariantsRunOnceWithAllStepsIfAsked) {
  study["scales"]["smoke"]["steps_for"] = {{variant, 4}};
  study["scales"]["smoke"]["whole_once"] = {variant};
  const SpeedupStudy on_one = load({with({{"ranks", {1, 2}}})}, 1);
  ASSERT_EQ(on_one.cells.size(), 3u) << "2 ranks share the core";
  EXPECT_EQ(on_one.cells[0].steps, 4);
  EXPECT_EQ(on_one.cells[2].steps, 10);
  EXPECT_TRUE(on_one.cells[2].is_whole_once);
  EXPECT_EQ(on_one.cells[2].ranks, 1);
  const SpeedupStudy on_two = load({with({{"ranks", {1, 2}}})}, 2);
  ASSERT_EQ(on_two.cells.size(), 4u);
  EXPECT_TRUE(on_two.cells[3].is_whole_once);
  EXPECT_EQ(on_two.cells[3].ranks, 2);
}

TEST_F(StudyOfRanks, CellsThatOthersAreComparedWithTakeTwiceAsManySamples) {
  study["scales"]["smoke"]["samples"] = 3;
  study["base"] = {variant};
  study["twin"] = "reference";
  const SpeedupStudy loaded = load({with({{"variants", {variant, "reference", "scalar"}}})});
  ASSERT_EQ(loaded.cells.size(), 4u);
  const std::size_t samples[] = {6, 6, 3, 6}; // base, the original of the twin, another, the twin
  for (std::size_t n = 0; n < 4; ++n)
    EXPECT_TRUE(contains(run_arguments(loaded, loaded.cells[n], {}), std::to_string(samples[n])))
        << loaded.cells[n].key();
}

TEST_F(StudyOfRanks, WrongKeysAreRefusedWithTheirPlace) {
  expect_refused({{"ranks", {1, "two"}}}, {"ranks.json", "/cells/0/ranks/1", "number of ranks"});
  expect_refused({{"ranks", {0}}}, {"/cells/0/ranks/0", "0"});
  expect_refused({{"ranks", json::array()}}, {"/cells/0/ranks", "empty"});
  expect_refused({{"halos", {"depe"}}}, {"/cells/0/halos", "\"deep\"", "shared"});
  expect_refused({{"decompositions", {"strip"}}}, {"/cells/0/decompositions", "\"strips\""});
  expect_refused({{"halo", "deep"}}, {"/cells/0", "\"halos\""});
  expect_refused({{"ranks", {2}}, {"variants", {variant, "reference"}}},
                 {"/cells/0/ranks", "reference", "1 rank"});
}

TEST_F(StudyOfRanks, AWeakScalingGrowsItsProblemWithTheRanks) {
  const json strong = with({{"ranks", {1, 2}}, {"halos", {"deep"}}});
  const json weak = with({{"ranks", {1, 2, 4, 6}}, {"weak", {{"parameter", "n"}, {"power", 2}}}});
  for (const auto& blocks : {std::vector{strong, weak}, std::vector{weak, strong}}) {
    const SpeedupStudy loaded = load(blocks, 6);
    ASSERT_EQ(loaded.cells.size(), 5u); // the cell on 1 rank belongs to both
    EXPECT_EQ(load(blocks, 4).cells.size(), 4u) << "more workers than cores show nothing";
    std::vector<std::string> sets;
    for (const Cell& cell : loaded.cells)
      if (!cell.weak_base_set.empty()) {
        EXPECT_EQ(cell.weak_base_set, "n=10");
        sets.push_back(cell.set_text());
      }
    EXPECT_EQ(sets, (std::vector<std::string>{"n=10", "n=14", "n=20", "n=24"}));
  }
}

TEST_F(StudyOfRanks, AWeakScalingThatCannotGrowIsRefused) {
  const json weak = {{"parameter", "n"}, {"power", 2}};
  expect_refused({{"ranks", {2, 4}}, {"weak", weak}}, {"/cells/0/weak", "1 rank"});
  expect_refused({{"ranks", {1, 2}}, {"weak", {{"parameter", "m"}, {"power", 2}}}},
                 {"/cells/0/weak/parameter", "\"m\""});
  expect_refused({{"ranks", {1, 2}}, {"weak", {{"parameter", "n"}}}}, {"/cells/0/weak", "power"});
  expect_refused({{"ranks", {1, 2}}, {"weak", {{"parameter", "n"}, {"power", 0}}}},
                 {"/cells/0/weak/power", "0"});
  expect_refused({{"ranks", {1, 2}},
                  {"set", {{"run.dt", 1e-7}}},
                  {"weak", {{"parameter", "run.dt"}, {"power", 1}}}},
                 {"/cells/0/weak/parameter", "run.dt=1e-07"});
}

TEST_F(StudyOfRanks, ATwinRunsOnOneRank) {
  study["twin"] = variant;
  const SpeedupStudy loaded =
      load({with({{"ranks", {1, 2, 4}}, {"weak", {{"parameter", "n"}, {"power", 2}}}}),
            with({{"ranks", {2}}})});
  EXPECT_EQ(std::count_if(loaded.cells.begin(), loaded.cells.end(),
                          [](const Cell& cell) { return cell.is_twin; }),
            1);
  EXPECT_EQ(loaded.cells.back().ranks, 1);
}

TEST_F(StudyOfRanks, WhatTwoBlocksNameIsMeasuredOnceAndWhatOneNamesTwiceIsRefused) {
  EXPECT_EQ(load({block, with({{"threads", {1, 2}}})}).cells.size(), 2u);
  expect_refused({{"variants", {variant, variant}}}, {"/cells/0", "twice"});
}

TEST_F(StudyOfRanks, ASimulationIsPartOfAStudy) {
  study["simulation"] = {{"platforms", {"x"}}};
  EXPECT_EQ(load({block}).cells.size(), 1u);
}

} // namespace
} // namespace dss
