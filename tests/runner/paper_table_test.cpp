/// The paper's tables from the tables of other studies.
#include "experiments/studies/paper/paper_study.hpp"
#include "solver/error.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

namespace dss {
namespace {

using nlohmann::json;

/// A table of the paper with a base, one process and two, on a machine of 4 cores.
class PaperTables : public test::OwnDirectory {
protected:
  PaperTables() {
    const json two = {{"set", "n=300"}, {"ranks", 2}, {"threads", "fill"}};
    spec = {{"experiment", "paper_table"},
            {"title", "A table"},
            {"paper_table",
             {{"source", "Table 1"},
              {"measured", "table"},
              {"steps", 1000},
              {"figure", "paper_figure"},
              {"simulated", {{"table", "table_simulated"}, {"where", {{"network", "fast"}}}}},
              {"bases", {"as_published", "scalar"}},
              {"ways",
               {{{"way", "the paper's"},
                 {"where", {{"variant", "avx2"}, {"halo", "sendrecv"}}},
                 {"simulated", {{"halo", "sendrecv"}}}},
                {{"way", "best"}}}},
              {"rows",
               {{{"row", "CPU"},
                 {"cells",
                  {{{"column", "T1"}, {"paper", 500}, {"is_base", true}, {"where", {{"ranks", 1}}}},
                   {{"column", "T2"}, {"paper", 50}, {"where", two}},
                   {{"column", "T1/T2"}, {"paper", 10}, {"speedup_of", "T2"}}}}}}}}},
            {"scales", {{"host", json::object()}}}};
    sources.machine = "a machine, 4 cores";
    add("as_published", 1, 1, "", 100, 40);
    add("scalar", 1, 1, "", 100, 10);
    add("avx2", 2, 2, "sendrecv", 1000, 20);
    add("avx2", 2, 2, "deep", 1000, 18);
    add("avx512", 2, 2, "deep", 1000, 16);
    add("avx512", 2, 1, "deep", 1000, 1); // does not fill the cores
    sources.simulated.rows.push_back({{"status", "ok"},
                                      {"network", "fast"},
                                      {"halo", "sendrecv"},
                                      {"ranks", "2"},
                                      {"steps", "1000"},
                                      {"simulated_paper_node_wall_s", "40"},
                                      {"simulated_own_node_wall_s", "5"}});
  }
  /// A measured cell; its speed-ups are those of the steps.
  void add(const std::string& variant, int ranks, int threads, const std::string& halo,
           double steps, double wall_s) {
    Record row = {{"source", "measured"},
                  {"label", fmt::format("{} {}", variant, halo)},
                  {"model", "spatial"},
                  {"precision", "f64"},
                  {"integrator", "rk4"},
                  {"set", "n=300"},
                  {"variant", variant},
                  {"cores", "4"},
                  {"ranks", fmt::format("{}", ranks)},
                  {"threads", fmt::format("{}", threads)},
                  {"halo", halo},
                  {"steps", number_text(steps)},
                  {"repetitions", "6"},
                  {"contaminated", "0"},
                  {"measured_wall_s", number_text(wall_s)},
                  {"measured_wall_low_s", number_text(0.9 * wall_s)},
                  {"measured_wall_high_s", number_text(1.1 * wall_s)},
                  {"status", "ok"}};
    for (const auto& [base, base_step_s] :
         {std::pair("as_published", 0.4), std::pair("scalar", 0.1)})
      for (const auto& [end, factor] :
           {std::pair("", 1.0), std::pair("_low", 0.9), std::pair("_high", 1.1)})
        row[fmt::format("extrapolated_speedup_vs_{}{}", base, end)] =
            number_text(base_step_s / (wall_s / steps) * factor);
    sources.measured.rows.push_back(row);
  }
  PaperStudy read() const {
    const std::string path = (directory / "paper.json").string();
    std::ofstream(path) << spec;
    return read_paper_study(open_study(path, "host"));
  }
  Table made() const { return paper_table(read(), sources); }
  Record row(const std::string& column, const std::string& way,
             const std::string& base = "") const {
    for (const Record& each : made().rows)
      if (text_in(each, "column") == column && text_in(each, "way") == way &&
          text_in(each, "base") == base)
        return each;
    ADD_FAILURE() << column << ' ' << way;
    return {};
  }
  json spec;
  PaperSources sources;
};

TEST_F(PaperTables, HaveThePapersOrderWithARowForEachWayAndBase) {
  std::vector<std::string> columns;
  for (const Record& each : made().rows)
    if (columns.empty() || columns.back() != text_in(each, "column"))
      columns.push_back(text_in(each, "column"));
  EXPECT_EQ(columns, (std::vector<std::string>{"T1", "T2", "T1/T2"}));
  EXPECT_EQ(made().rows.size(), 2u + 2 + 4);
  EXPECT_LE(made().columns.size(), 25u);
}

TEST_F(PaperTables, TimesAreScaledToThePapersStepsAndSaySo) {
  const Record base = row("T1", "the base", "as_published");
  EXPECT_DOUBLE_EQ(number_in(base, "measured"), 400);
  EXPECT_DOUBLE_EQ(number_in(base, "measured_low"), 360);
  EXPECT_EQ(text_in(base, "scaled"), "yes");
  EXPECT_DOUBLE_EQ(number_in(base, "paper"), 500);
  EXPECT_EQ(text_in(row("T2", "best"), "scaled"), "no");
}

TEST_F(PaperTables, ThePapersWayIsItsOwnAndTheBestIsTheFastestThatFillsTheCores) {
  EXPECT_EQ(text_in(row("T2", "the paper's"), "ran"), "avx2 sendrecv");
  const Record best = row("T2", "best");
  EXPECT_EQ(text_in(best, "ran"), "avx512 deep");
  EXPECT_DOUBLE_EQ(number_in(best, "measured"), 16);
  EXPECT_DOUBLE_EQ(number_in(row("T1/T2", "best", "as_published"), "measured"), 25);
  EXPECT_DOUBLE_EQ(number_in(row("T1/T2", "best", "scalar"), "measured"), 6.25);
}

TEST_F(PaperTables, SimulatedFiguresStandApart) {
  EXPECT_DOUBLE_EQ(number_in(row("T2", "the paper's"), "simulated_paper_node"), 40);
  EXPECT_DOUBLE_EQ(number_in(row("T2", "the paper's"), "simulated_own_node"), 5);
  EXPECT_DOUBLE_EQ(number_in(row("T1/T2", "the paper's", "scalar"), "simulated_paper_node"),
                   500.0 / 40);
  EXPECT_EQ(text_in(row("T2", "best"), "simulated_paper_node"), "");
}

TEST_F(PaperTables, AFigureWithoutAnIntervalIsNotShown) {
  sources.measured.rows[4].erase("measured_wall_low_s");
  const Record best = row("T2", "best");
  EXPECT_EQ(text_in(best, "measured"), "");
  EXPECT_EQ(text_in(best, "ran"), "avx512 deep");
}

TEST_F(PaperTables, WhatDidNotRunSaysWhyAndAnotherMachineMayAnswer) {
  for (std::size_t n = 2; n < 6; ++n) {
    sources.measured.rows[n]["status"] = "oversubscribed";
    sources.measured.rows[n]["reason"] = "";
  }
  EXPECT_EQ(text_in(row("T2", "best"), "status"), "oversubscribed");
  EXPECT_EQ(text_in(row("T2", "best"), "measured"), "");
  sources.elsewhere.rows = {sources.measured.rows[4]};
  sources.elsewhere.rows[0]["status"] = "ok";
  sources.machine_elsewhere = "there";
  EXPECT_EQ(text_in(row("T2", "best"), "machine"), "there");
  EXPECT_DOUBLE_EQ(number_in(row("T2", "best"), "measured"), 16);
}

TEST_F(PaperTables, AnotherProblemIsNotThePapers) {
  for (Record& each : sources.measured.rows) each["set"] = "n=20";
  EXPECT_EQ(text_in(row("T2", "best"), "status"), "not measured at scale host");
}

TEST_F(PaperTables, TheFigureHasTheTimesAlone) {
  const Table figure = paper_figure(read(), made());
  EXPECT_EQ(figure.rows.size(), 4u);
  EXPECT_EQ(text_in(figure.rows[3], "measured_s"), "16");
}

TEST_F(PaperTables, ASpeedUpOfAnUnknownColumnIsRefused) {
  spec["paper_table"]["rows"][0]["cells"][2]["speedup_of"] = "T3";
  try {
    read();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/rows/0/cells/2/speedup_of: no cell before this one"),
              std::string::npos)
        << error.what();
  }
}

} // namespace
} // namespace dss
