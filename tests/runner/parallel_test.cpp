#include "experiments/base/parallel.hpp"

#include <atomic>
#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

namespace dss {
namespace {

TEST(ForEachOnAllCores, does_each_piece_once) {
  std::vector<int> done(1000, 0);
  for_each_on_all_cores(done.size(), [&](std::size_t n) { ++done[n]; });
  EXPECT_EQ(done, std::vector<int>(1000, 1));
}

TEST(ForEachOnAllCores, does_nothing_of_nothing) {
  for_each_on_all_cores(0, [](std::size_t) { FAIL(); });
}

TEST(ForEachOnAllCores, passes_a_failure_on_and_begins_nothing_after_it) {
  std::atomic<int> begun = 0;
  const auto fail = [&](std::size_t) {
    ++begun;
    throw std::runtime_error("piece");
  };
  EXPECT_THROW(for_each_on_all_cores(100'000, fail), std::runtime_error);
  EXPECT_LT(begun, 100'000);
}

} // namespace
} // namespace dss
