/// The effort that a study spends on clean timings.
#include "experiments/base/clock.hpp"
#include "experiments/measure/patience.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

TEST(Patience, AQuietMachineCostsNothing) {
  Progress progress;
  Patience patience(10, progress, [] { return ""; });
  patience.wait();
  EXPECT_EQ(patience.report(), "");
  EXPECT_TRUE(patience.allows(10));
  EXPECT_FALSE(patience.allows(10.1));
}

TEST(Patience, WaitsUntilTheMachineIsQuiet) {
  Progress progress;
  int looks = 0;
  Patience patience(1000, progress, [&] { return ++looks < 3 ? "a program runs" : ""; });
  patience.wait();
  EXPECT_EQ(looks, 3);
  EXPECT_NE(patience.report().find("waited 1 times"), std::string::npos) << patience.report();
}

TEST(Patience, WaitsForATenthOfTheEffortAtMostAndNotWithoutAny) {
  Progress progress;
  const auto always = [] { return "a program runs"; };
  Patience patience(1, progress, always), none(0, progress, always);
  const auto start = Clock::now();
  patience.wait();
  none.wait();
  EXPECT_LT(seconds_since(start), 5);
  EXPECT_FALSE(patience.allows(0.95));
  EXPECT_EQ(none.report(), "");
}

TEST(Patience, RepetitionsSpendTheSameEffort) {
  Progress progress;
  Patience patience(10, progress, [] { return ""; });
  patience.spend(4);
  patience.spend(4);
  EXPECT_TRUE(patience.allows(2));
  EXPECT_FALSE(patience.allows(3));
  EXPECT_EQ(patience.report(), "waited 0 times for a quiet machine, 0 s; repeated 2 disturbed "
                               "repetitions, 8 s; at most 10 s together");
}

} // namespace
} // namespace dss
