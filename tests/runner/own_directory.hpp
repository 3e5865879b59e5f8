#pragma once
#include <filesystem>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <string>

namespace dss::test {

/// A test with a directory of its own, which it removes at the end.
class OwnDirectory : public ::testing::Test {
protected:
  OwnDirectory() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "dssbench-test-XXXXXX").string();
    directory = ::mkdtemp(pattern.data());
  }
  ~OwnDirectory() override { std::filesystem::remove_all(directory); }
  std::string file(const char* name) const { return (directory / name).string(); }
  std::filesystem::path directory;
};

} // namespace dss::test
