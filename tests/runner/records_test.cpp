#include "experiments/base/records.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace dss {
namespace {

namespace fs = std::filesystem;

using Records = test::OwnDirectory;

TEST_F(Records, NumbersComeBackToTheLastBit) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, -2.5e17})
    EXPECT_EQ(number_in({{"a", number_text(value)}}, "a"), value);
  EXPECT_TRUE(std::isnan(number_in({}, "a")));
  EXPECT_EQ(number_text(std::nan("")), "");
  EXPECT_THROW(number_in({{"a", "1,5"}}, "a"), InputError);
}

TEST_F(Records, CommasQuotesAndLineBreaksStayInOneValueOfOneLine) {
  const std::string line = csv_line({"a", "b"}, {{"a", "x, \"y\"\nz"}, {"b", "2"}});
  EXPECT_EQ(line, "\"x, \"\"y\"\" z\",2\n");
  EXPECT_EQ(split_csv(line.substr(0, line.size() - 1), "here"),
            (std::vector<std::string>{"x, \"y\" z", "2"}));
}

TEST_F(Records, RowsAreInTheFileWhenAppendReturns) {
  RecordFile records(file("a.csv"), {"x", "y"}, false);
  records.append({{"x", "1"}, {"y", "2"}});
  EXPECT_EQ(read_text(file("a.csv")), "x,y\n1,2\n");
}

TEST_F(Records, ResumingKeepsWholeRowsAndDropsATornLastLine) {
  std::ofstream(file("a.csv")) << "x,y\n1,2\n3,4\n5,";
  RecordFile records(file("a.csv"), {"x", "y"}, true);
  ASSERT_EQ(records.present().size(), 2u);
  EXPECT_EQ(text_in(records.present()[1], "y"), "4");
  records.append({{"x", "7"}, {"y", "8"}});
  EXPECT_EQ(read_text(file("a.csv")), "x,y\n1,2\n3,4\n7,8\n");
}

TEST_F(Records, ResumingWithOtherColumnsIsRefusedAndLeavesTheFile) {
  std::ofstream(file("a.csv")) << "x,z\n1,2\n";
  EXPECT_THROW(RecordFile(file("a.csv"), {"x", "y"}, true), InputError);
  EXPECT_EQ(read_text(file("a.csv")), "x,z\n1,2\n");
}

TEST_F(Records, RowsOfAnotherLengthAreRefusedWithTheirLine) {
  std::ofstream(file("a.csv")) << "x,y\n1,2\n3\n";
  try {
    read_csv(file("a.csv"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a.csv:3"), std::string::npos) << error.what();
  }
}

TEST_F(Records, AnUncommittedFileLeavesNothingAndTheEarlierOneStays) {
  std::ofstream(file("a.txt")) << "earlier";
  {
    AtomicFile unfinished(file("a.txt"));
    unfinished.write(std::string(1 << 20, 'x'));
  }
  EXPECT_EQ(read_text(file("a.txt")), "earlier");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory), fs::directory_iterator()), 1);
}

TEST_F(Records, ADiskThatIsFullIsAnInputError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  AtomicFile full("/dev/full");
  full.write("some bytes");
  EXPECT_THROW(full.commit(), InputError);
}

TEST_F(Records, AMissingDirectoryIsFoundBeforeAnythingIsComputed) {
  EXPECT_THROW(require_writable(file("missing/a.csv")), InputError);
  EXPECT_NO_THROW(require_writable(file("a.csv")));
  EXPECT_FALSE(fs::exists(file("a.csv")));
}

} // namespace
} // namespace dss
