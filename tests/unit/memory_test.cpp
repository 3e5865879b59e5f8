/// Memory that is available, as files of the kernel tell it.
#include "solver/error.hpp"
#include "solver/memory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace dss {
namespace {

namespace fs = std::filesystem;

class AvailableMemory : public testing::Test {
protected:
  AvailableMemory()
      : root_(fs::temp_directory_path() / ("dss_memory_" + std::to_string(getpid()))) {
    write("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable: 4000 kB\n");
  }
  ~AvailableMemory() override { fs::remove_all(root_); }
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  double found() const { return available_memory(root_); }
  fs::path root_;
};

TEST_F(AvailableMemory, IsWhatTheKernelSays) { EXPECT_EQ(found(), 4000 * 1024); }

TEST_F(AvailableMemory, IsUnlimitedWhereNothingTells) {
  fs::remove_all(root_ / "proc");
  EXPECT_GT(found(), 1e15);
}

TEST_F(AvailableMemory, IsWhatItsGroupLeaves) {
  write("sys/fs/cgroup/memory.max", "3000000\n");
  write("sys/fs/cgroup/memory.current", "2900000\n");
  EXPECT_EQ(found(), 100000);
  // The kernel takes pages of files back.
  write("sys/fs/cgroup/memory.stat", "anon 5\ninactive_file 500000\nactive_file 300000\n");
  EXPECT_EQ(found(), 900000);
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(found(), 4000 * 1024);
}

TEST_F(AvailableMemory, IsWhatAGroupOfTheFirstVersionLeaves) {
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "3000000\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "2900000\n");
  write("sys/fs/cgroup/memory/memory.stat",
        "inactive_file 1\ntotal_inactive_file 50000\ntotal_active_file 1000\n");
  EXPECT_EQ(found(), 151000);
}

TEST(RequiredMemory, IsToldWhereItIsLacking) {
  require_memory(1, "bytes", "");
  try {
    require_memory(1e30, "things", "take fewer");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("things need 1e+21 GB"), std::string::npos)
        << error.what();
  }
}

} // namespace
} // namespace dss
