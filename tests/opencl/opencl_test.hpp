#pragma once
/// A test on the first OpenCL device. It has a binary cache of its own.
#include "variants/opencl/queue.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <unistd.h>

namespace dss::test {

class OpenClTest : public testing::Test {
protected:
  void SetUp() override {
    if (const std::string why = opencl::why_unusable(); !why.empty()) GTEST_SKIP() << why;
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    cache =
        std::filesystem::temp_directory_path() / ("dssbench-" + std::to_string(::getpid()) + name);
    std::filesystem::remove_all(cache);
    ::setenv("DSSBENCH_CACHE_DIR", cache.c_str(), 1);
    device = opencl::find_device("", Precision::f32);
  }
  void TearDown() override { std::filesystem::remove_all(cache); }

  std::filesystem::path cache;
  opencl::Device device;
};

} // namespace dss::test
