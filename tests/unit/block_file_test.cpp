/// Files of blocks, and members as lists of numbers.
#include "solver/error.hpp"
#include "solver/io/block_file.hpp"
#include "solver/io/kept_numbers.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace dss {
namespace {

namespace fs = std::filesystem;
using Blocks = std::vector<std::vector<double>>;

const Blocks some_blocks = {{1, -0.0, 1e-310}, {std::numeric_limits<double>::infinity()}, {2, 3}};

class BlockFiles : public testing::Test {
protected:
  BlockFiles() : folder_(fs::temp_directory_path() / ("dss_blocks_" + std::to_string(getpid()))) {
    fs::create_directory(folder_);
    path_ = folder_ / "file";
  }
  ~BlockFiles() override { fs::remove_all(folder_); }

  void write(const Blocks& blocks, const std::string& earlier = {}) const {
    BlockWriter writer(path_, {{"count", blocks.size()}});
    for (const auto& block : blocks) writer.write(block);
    writer.commit(earlier);
  }
  static Blocks read(const std::string& path) {
    BlockReader reader(path);
    Blocks blocks;
    for (std::size_t b = 0; b < reader.head().at("count").get<std::size_t>(); ++b)
      blocks.push_back(reader.next());
    reader.require_end();
    return blocks;
  }
  std::string text() const { return read_text(path_); }
  bool is_refused(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
    try {
      read(path_);
    } catch (const InputError&) {
      return true;
    }
    return false;
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(BlockFiles, AreReadAsWritten) {
  write(some_blocks);
  const Blocks found = read(path_);
  EXPECT_EQ(found, some_blocks);
  EXPECT_TRUE(std::signbit(found[0][1]));
}

TEST_F(BlockFiles, AreRefusedWithAnyBitFlipped) {
  write(some_blocks);
  const std::string whole = text();
  for (std::size_t place = 0; place < whole.size(); ++place)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[place] = char(damaged[place] ^ (1 << bit));
      EXPECT_TRUE(is_refused(damaged)) << "byte " << place << ", bit " << bit;
    }
}

TEST_F(BlockFiles, AreRefusedAtAnyOtherLength) {
  write(some_blocks);
  const std::string whole = text();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_TRUE(is_refused(whole.substr(0, length))) << length;
  EXPECT_TRUE(is_refused(whole + "x"));
  EXPECT_FALSE(is_refused(whole));
}

TEST_F(BlockFiles, AreRefusedWithBlocksExchanged) {
  write({{1, 2}, {3, 4}});
  const std::string whole = text();
  constexpr std::size_t block = 4 * 8, end = 2 * 8;
  const std::size_t first = whole.size() - end - 2 * block;
  EXPECT_TRUE(is_refused(whole.substr(0, first) + whole.substr(first + block, block) +
                         whole.substr(first, block) + whole.substr(first + 2 * block)));
}

TEST_F(BlockFiles, KeepTheFileBefore) {
  const std::string earlier = path_ + ".previous";
  write({{1}}, earlier);
  EXPECT_FALSE(fs::exists(earlier));
  write({{2}}, earlier);
  write({{3}}, earlier);
  EXPECT_EQ(read(path_), (Blocks{{3}}));
  EXPECT_EQ(read(earlier), (Blocks{{2}}));
}

TEST_F(BlockFiles, LeaveNothingWithoutCommit) {
  { BlockWriter(path_, {{"count", 1}}).write(some_blocks[0]); }
  EXPECT_TRUE(fs::is_empty(folder_));
}

struct Members {
  double time = 0;
  long steps = 0;
  bool is_done = false;
  std::array<double, 2> errors{};
  std::vector<double> state;
  bool operator==(const Members&) const = default;
  template <class Visit>
  void each_kept(Visit&& visit) {
    visit(time), visit(steps), visit(is_done), visit(errors), visit(state);
  }
};

TEST(KeptNumbers, AreTheMembersThatWerePut) {
  Members members{0.1, 1L << 53, true, {1, 2}, {3, 4, 5}}, found;
  found.state.resize(3);
  std::vector<double> list;
  PutNumbers put(list);
  members.each_kept(put);
  TakeNumbers take(list);
  found.each_kept(take);
  EXPECT_EQ(found, members);
  EXPECT_TRUE(take.is_empty());
}

TEST(KeptNumbers, AreRefusedIfTheyAreNotOfTheirType) {
  const auto is_refused = [](auto member, std::vector<double> list) {
    TakeNumbers take(list);
    try {
      take(member);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  for (const double wrong : {-1.0, 0.5, 1e300, std::nan("")}) {
    EXPECT_TRUE(is_refused(0, {wrong}));
    EXPECT_TRUE(is_refused(0L, {wrong}));
  }
  EXPECT_TRUE(is_refused(false, {2}));
  EXPECT_TRUE(is_refused(0, {3e9}));
  EXPECT_FALSE(is_refused(0L, {3e9}));
  EXPECT_TRUE(is_refused(std::vector<double>(2), {3, 1, 2, 3}));
  EXPECT_FALSE(is_refused(std::vector<double>(3), {3, 1, 2, 3}));
}

TEST(KeptNumbers, AreRefusedIfTooFew) {
  Members members{0, 0, false, {}, {1, 2}};
  std::vector<double> list;
  PutNumbers put(list);
  members.each_kept(put);
  for (std::size_t count = 0; count < list.size(); ++count) {
    TakeNumbers take(std::span<const double>(list).first(count));
    EXPECT_THROW(members.each_kept(take), InputError) << count;
  }
}

} // namespace
} // namespace dss
