#include "experiments/base/child.hpp"
#include "solver/error.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

ChildResult shell(const std::string& script, double limit_s = 20) {
  return run_child("/bin/sh", {"sh", "-c", script}, limit_s);
}

TEST(Child, OutputAndErrorAreKeptApart) {
  const ChildResult result = shell("echo out; echo err >&2");
  EXPECT_EQ(result.output, "out\n");
  EXPECT_EQ(result.error, "err\n");
  EXPECT_EQ(result.failure(20), "");
}

TEST(Child, ExitCodeAndFirstLineOfErrorAreTheReason) {
  EXPECT_EQ(shell("echo why >&2; echo more >&2; exit 3").failure(20), "exit code 3: why");
}

TEST(Child, ASignalIsTheReason) {
  EXPECT_NE(shell("kill -SEGV $$").failure(20).find("signal 11"), std::string::npos);
}

TEST(Child, ATimeLimitEndsIt) {
  const ChildResult result = shell("exec sleep 30", 0.2);
  EXPECT_TRUE(result.timed_out);
  EXPECT_LT(result.wall_s, 10);
  EXPECT_EQ(result.failure(0.2), "time limit of 0.2 s");
}

TEST(Child, ATimeLimitHoldsForAChildThatClosedItsOutputs) {
  EXPECT_TRUE(shell("exec >/dev/null 2>&1; exec sleep 30", 0.3).timed_out);
}

TEST(Child, MuchOutputDoesNotBlockIt) {
  EXPECT_EQ(shell("head -c 3000000 /dev/zero").output.size(), 3'000'000u);
}

TEST(Child, AProgramThatDoesNotExistIsAnInputError) {
  EXPECT_THROW(run_child("/does/not/exist", {"x"}, 1), InputError);
}

} // namespace
} // namespace dss
