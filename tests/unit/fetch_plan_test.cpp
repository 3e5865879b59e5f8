/// Which tasks fetch which rows ahead of their use.
#include "variants/engine/fetch_plan.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace dss {
namespace {

TEST(FetchPlan, DividesARowAmongTasksThatAreEarlyEnough) {
  constexpr int count = 100, packs = 8, lines = 16;
  for (const int shares : {1, 2, 3}) {
    FetchPlan plan(std::vector<long>(count, packs), shares);
    std::vector<char> rows(std::size_t(count) * lines * 64);
    const auto row = [&](int n) { return rows.data() + std::size_t(n) * lines * 64; };
    for (int n = 0; n < count; n += 4) plan.first_read(std::size_t(n), row(n), lines * 64);
    std::vector<int> fetched(std::size_t(count) * lines);
    for (int n = 0; n < count; ++n) {
      const auto& [from, of_pack] = plan.fetches()[std::size_t(n)];
      if (from == nullptr) continue;
      const auto line = std::size_t(from - rows.data()) / 64;
      for (std::size_t k = 0; k < std::size_t(packs * of_pack) && line + k < fetched.size(); ++k)
        ++fetched[line + k];
      EXPECT_LE(n * packs + FetchPlan::lead, long(line / lines) * packs);
    }
    for (int n = 4; n < count; n += 4)
      for (std::size_t k = 0; k < lines; ++k)
        EXPECT_GE(fetched[std::size_t(n) * lines + k], 1) << "line " << k << " of row " << n;
  }
}

TEST(FetchPlan, LetsNoShortTaskFetchALongRow) {
  FetchPlan plan({100, 1, 100, 1, 100}, 1);
  const std::vector<char> row(100 * 64);
  plan.first_read(4, row.data(), row.size());
  EXPECT_EQ(plan.fetches()[2].row, row.data());
  for (const std::size_t n : {0, 1, 3, 4}) EXPECT_EQ(plan.fetches()[n].row, nullptr);
}

TEST(FetchPlan, LetsAReaderWithoutTasksBeforeItFetchItsRow) {
  FetchPlan plan({100, 100}, 2);
  const std::vector<char> row(100 * 64);
  plan.first_read(0, row.data(), row.size());
  EXPECT_EQ(plan.fetches()[0].row, row.data() + FetchPlan::lead * 64);
  EXPECT_EQ(plan.fetches()[1].row, nullptr);
}

} // namespace
} // namespace dss
