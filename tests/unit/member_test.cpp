/// Members of a hybrid as text.
#include "solver/error.hpp"
#include "variants/api/member.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

TEST(Members, are_read_with_device_threads_and_weight) {
  const std::vector<Member> members =
      parse_members("avx512:3=1,opencl@cpu:2=9.5,opencl@[0:1]:4=1e-1,avx2=2");
  ASSERT_EQ(members.size(), 4u);
  EXPECT_EQ(members[0].variant, "avx512");
  EXPECT_EQ(members[0].device, "");
  EXPECT_EQ(members[0].threads, 3);
  EXPECT_EQ(members[1].device, "cpu");
  EXPECT_EQ(members[1].weight, 9.5);
  EXPECT_EQ(members[2].device, "0:1");
  EXPECT_EQ(members[2].threads, 4);
  EXPECT_EQ(members[2].weight, 0.1);
  EXPECT_EQ(members[3].threads, 1);
}

TEST(Members, without_weights_are_weighted_as_measured) {
  for (const Member& member : parse_members("avx512,opencl@gpu")) EXPECT_EQ(member.weight, 0);
}

TEST(Members, have_names_that_are_read_back) {
  for (const char* text :
       {"avx512:2", "opencl@gpu:1", "opencl@[0:1]:1", "opencl@[NVIDIA, Inc.=1]:7", "opencl@[0]:1"})
    EXPECT_EQ(name(parse_members(text).front()), text);
  EXPECT_EQ(name(parse_members("opencl@NVIDIA H100").front()), "opencl@NVIDIA H100:1");
}

TEST(Members, that_are_wrong_are_refused_in_one_line_that_names_them) {
  const auto refusal = [](const char* text) -> std::string {
    try {
      parse_members(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("avx2,opencl@0:1")
                .find("member \"opencl@0:1\": device 0 is a number; write a device in brackets"),
            std::string::npos);
  EXPECT_NE(refusal("").find("has no variant"), std::string::npos);
  EXPECT_NE(refusal("avx2,").find("has no variant"), std::string::npos);
  EXPECT_NE(refusal("avx2:0").find("\"0\" is not a number of threads"), std::string::npos);
  EXPECT_NE(refusal("avx2:two").find("not a number of threads"), std::string::npos);
  EXPECT_NE(refusal("avx2=-1").find("\"-1\" is not a weight"), std::string::npos);
  EXPECT_NE(refusal("avx2=nan").find("not a weight"), std::string::npos);
  EXPECT_NE(refusal("opencl@").find("has no device"), std::string::npos);
  EXPECT_NE(refusal("opencl@[0:1").find("not closed"), std::string::npos);
  EXPECT_NE(refusal("opencl@[0:1]x").find("\"x\" is too much"), std::string::npos);
  EXPECT_NE(refusal("avx2=1,avx512").find("1 of 2 members have a weight"), std::string::npos);
  EXPECT_EQ(refusal("opencl@[0:1").find('\n'), std::string::npos);
}

} // namespace
} // namespace dss::test
