/// Memory of a device: refused before it is allocated, returned, mapped. Embedded text.
#include "solver/error.hpp"
#include "tests/opencl/opencl_test.hpp"
#include "variants/opencl/embedded.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace dss::test {
namespace {

using OpenClMemory = OpenClTest;

TEST_F(OpenClMemory, of_more_than_the_largest_buffer_is_refused_in_gibibytes) {
  const opencl::Queue queue(device);
  try {
    queue.make_buffer(std::size_t(device.entry.largest_buffer_bytes) + 1);
    FAIL() << "it was allocated";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("GiB"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST_F(OpenClMemory,
       in_many_buffers_is_refused_when_their_sum_is_too_much_and_is_there_again_afterwards) {
  device.entry.memory_bytes = 1 << 20;
  const opencl::Queue queue(device);
  {
    const opencl::Buffer most = queue.make_buffer(1 << 19);
    const opencl::Buffer shared = most;
    EXPECT_THROW(queue.make_buffer((1 << 19) + 1), InputError);
  }
  EXPECT_EQ(queue.make_buffer((1 << 19) + 1).bytes(), std::size_t((1 << 19) + 1));
}

TEST_F(OpenClMemory, is_cleared_copied_and_mapped) {
  opencl::Queue queue(device);
  const opencl::Buffer first = queue.make_buffer(64), second = queue.make_buffer(64);
  queue.clear(first);
  queue.map(first, 8, 8, CL_MAP_WRITE).as<int>()[1] = 7;
  queue.copy(first, 8, second, 0, 8);
  const auto mapped = queue.map(second, 0, 8, CL_MAP_READ);
  EXPECT_EQ(mapped.as<int>()[0], 0);
  EXPECT_EQ(mapped.as<int>()[1], 7);
}

TEST_F(OpenClMemory, and_an_empty_launch_take_some_time) {
  opencl::Queue queue(device);
  EXPECT_GT(queue.empty_launch_s(), 0);
  EXPECT_EQ(queue.counts().launches, 0);
}

TEST(EmbeddedText, is_that_of_the_file) {
  std::ifstream file(DSS_SOURCE_DIR "/kernels/algebra/spatial.h");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(embedded("kernels/algebra/spatial.h"), text.str());
  EXPECT_THROW(embedded("kernels/none.h"), std::out_of_range);
}

} // namespace
} // namespace dss::test
