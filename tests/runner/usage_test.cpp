/// Judgement of disturbed timings.
#include "experiments/base/clock.hpp"
#include "experiments/base/quiet.hpp"
#include "experiments/base/usage.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace dss {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Usage used_by(double cpu_s, double wait_s, double steal_s = 0) {
  return {cpu_s, wait_s, steal_s, unknown, 0};
}

TEST(Contamination, WaitingForAProcessorCountsForAnyNumberOfWorkers) {
  for (const int workers : {1, 2, 16}) {
    const double available_s = 0.5 * workers;
    EXPECT_TRUE(is_contaminated(used_by(available_s, 0.011 * available_s), 0.5, workers));
    EXPECT_FALSE(is_contaminated(used_by(available_s, 0.009 * available_s), 0.5, workers));
    EXPECT_TRUE(is_contaminated(used_by(available_s, 0, 0.011 * available_s), 0.5, workers));
    EXPECT_TRUE(is_contaminated(used_by(available_s, unknown, 0.011 * available_s), 0.5, workers));
    EXPECT_FALSE(is_contaminated(used_by(available_s, unknown), 0.5, workers));
  }
}

/// A thread that sleeps until another arrives loses CPU time; a rank that spins does not.
TEST(Contamination, WaitingForOtherWorkersDoesNotCountAsleepOrSpinning) {
  EXPECT_FALSE(is_contaminated(used_by(0.8, 0), 0.5, 2));
  EXPECT_FALSE(is_contaminated(used_by(1.0, 0), 0.5, 2));
}

TEST(Contamination, ASingleWorkerHasNobodyToWaitFor) {
  EXPECT_TRUE(is_contaminated(used_by(0.48, 0), 0.5, 1));
  EXPECT_FALSE(is_contaminated(used_by(0.49, 0), 0.5, 1));
  EXPECT_FALSE(is_contaminated(used_by(0.0, 0), 0.01, 1)) << "the clock of CPU time is too coarse";
}

/// Threads of such a device and those that wait for them share processors.
TEST(Contamination, WorkersThatWaitForADeviceAreDisturbedByOthersAlone) {
  Usage used = used_by(0.9, 0.7);
  EXPECT_TRUE(is_contaminated(used, 0.5, 2, true)) << "nothing is known of others";
  used.others_s = 0.015;
  EXPECT_FALSE(is_contaminated(used, 0.5, 2, true));
  EXPECT_TRUE(is_contaminated(used, 0.5, 2)) << "workers that do not share wait for others alone";
  used.others_s = 0.025;
  EXPECT_TRUE(is_contaminated(used, 0.5, 2, true));
  used.wait_s = 0.009;
  EXPECT_FALSE(is_contaminated(used, 0.5, 2, true)) << "others ran elsewhere";
  used.others_s = -0.02;
  EXPECT_FALSE(is_contaminated(used, 0.5, 2, true));
}

TEST(UsageMeter, SeesTheTimeThatThisThreadComputes) {
  const UsageMeter meter;
  const auto start = Clock::now();
  double sum = 0;
  while (seconds_since(start) < 0.05) sum += 1;
  const Usage used = meter.read();
  EXPECT_GT(sum, 0);
  EXPECT_GT(used.cpu_s + used.wait_s + used.steal_s, 0.03);
  EXPECT_GE(used.steal_s, 0);
}

TEST(Disturbance, SaysHowManyThreadsRunOrNothing) {
  const std::string text = disturbance();
  EXPECT_TRUE(text.empty() || text.find("running") != std::string::npos) << text;
}

} // namespace
} // namespace dss
