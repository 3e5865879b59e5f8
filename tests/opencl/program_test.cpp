/// Programs: messages of the compiler, and the cache of binaries.
#include "solver/error.hpp"
#include "tests/opencl/opencl_test.hpp"
#include "variants/opencl/binary_cache.hpp"

#include <array>
#include <fmt/format.h>
#include <fstream>
#include <numeric>

namespace dss::test {
namespace {

/// A new program for each call, because a process builds a program only once.
std::string doubling_source() {
  static int number = 0;
  return fmt::format("__kernel void doubled(__global float *x, int n) {{ int i = get_global_id(0); "
                     "if (i < n) x[i] *= "
                     "2; }} /* {} of {} */",
                     ++number, ::getpid());
}

class OpenClPrograms : public OpenClTest {
protected:
  std::filesystem::path only_file() const {
    const auto files = std::filesystem::directory_iterator(cache);
    EXPECT_EQ(std::distance(begin(files), end(files)), 1);
    return std::filesystem::directory_iterator(cache)->path();
  }
  /// The key of the only file, as load_binary accepts it: from the third line on, with the length
  /// in the second.
  static std::string key_in(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string title, size;
    std::getline(file, title);
    std::getline(file, size);
    std::string key(std::stoul(size), '\0');
    file.read(key.data(), std::streamsize(key.size()));
    return key;
  }
  void expect_doubles(const opencl::Program& program) {
    opencl::Queue queue(device);
    std::array<float, 100> numbers{};
    std::iota(numbers.begin(), numbers.end(), 1.0f);
    const opencl::Buffer buffer = queue.make_buffer(sizeof numbers);
    queue.write(buffer, 0, std::as_bytes(std::span(numbers)));
    opencl::Kernel kernel = queue.make_kernel(program, "doubled");
    kernel.set(buffer, cl_int(99));
    queue.launch(kernel, cl::NDRange(100));
    queue.read(buffer, 0, std::as_writable_bytes(std::span(numbers)));
    EXPECT_EQ(numbers[0], 2);
    EXPECT_EQ(numbers[98], 198);
    EXPECT_EQ(numbers[99], 100);
    EXPECT_EQ(queue.counts().launches, 1);
    EXPECT_EQ(queue.counts().to_device_bytes, 400);
    EXPECT_EQ(queue.counts().from_device_bytes, 400);
  }
};

TEST_F(OpenClPrograms, run_and_are_built_once_in_a_process) {
  const std::string source = doubling_source();
  const opencl::Program first = opencl::build_program(device, source),
                        second = opencl::build_program(device, source);
  EXPECT_FALSE(first.is_cached);
  EXPECT_TRUE(second.is_cached);
  EXPECT_EQ(first.handle(), second.handle());
  expect_doubles(first);
}

TEST_F(OpenClPrograms, leave_a_binary_that_is_found_by_its_key) {
  opencl::build_program(device, doubling_source());
  const std::string key = key_in(only_file());
  EXPECT_NE(key.find("doubled"), std::string::npos);
  EXPECT_NE(key.find(device.entry.name), std::string::npos);
  EXPECT_TRUE(opencl::load_binary(key));
  EXPECT_FALSE(opencl::load_binary(key + " "));
}

TEST_F(OpenClPrograms, are_built_from_a_binary_and_from_source_if_the_driver_refuses_it) {
  const std::string source = doubling_source();
  opencl::build_program(device, source);
  std::string key = key_in(only_file());
  const std::optional<std::string> binary = opencl::load_binary(key);
  ASSERT_TRUE(binary);
  // Another program: its number has another digit and the same length.
  const std::string other = doubling_source();
  key.replace(key.rfind(source), source.size(), other);
  opencl::store_binary(key, *binary);
  const opencl::Program program = opencl::build_program(device, other);
  EXPECT_TRUE(program.is_cached);
  expect_doubles(program);

  const std::string third = doubling_source();
  key.replace(key.rfind(other), other.size(), third);
  opencl::store_binary(key, "no program at all");
  const opencl::Program rebuilt = opencl::build_program(device, third);
  EXPECT_FALSE(rebuilt.is_cached);
  expect_doubles(rebuilt);
}

TEST_F(OpenClPrograms, ignore_a_damaged_binary) {
  opencl::build_program(device, doubling_source());
  const std::filesystem::path path = only_file();
  const std::string key = key_in(path);
  ASSERT_TRUE(opencl::load_binary(key));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_FALSE(opencl::load_binary(key));
  std::ofstream(path) << "rubbish";
  EXPECT_FALSE(opencl::load_binary(key));
}

TEST_F(OpenClPrograms, ignore_a_binary_that_others_may_have_written) {
  opencl::build_program(device, doubling_source());
  const std::filesystem::path path = only_file(), folder = path.parent_path();
  const std::string key = key_in(path);
  using std::filesystem::perms;
  for (const auto& place : {path, folder})
    for (const perms right : {perms::group_write, perms::others_write}) {
      const perms before = std::filesystem::status(place).permissions();
      std::filesystem::permissions(place, before | right);
      EXPECT_FALSE(opencl::load_binary(key)) << place;
      std::filesystem::permissions(place, before);
      EXPECT_TRUE(opencl::load_binary(key)) << place;
    }
}

TEST_F(OpenClPrograms, work_where_nothing_can_be_cached) {
  ::setenv("DSSBENCH_CACHE_DIR", "/proc/nowhere", 1);
  const opencl::Program program = opencl::build_program(device, doubling_source());
  EXPECT_FALSE(program.is_cached);
  expect_doubles(program);
}

TEST_F(OpenClPrograms, that_do_not_compile_show_the_log_after_a_line_that_says_where) {
  try {
    opencl::build_program(device,
                          "__kernel void broken(__global float *x) { x[0] = no_such_name; }");
    FAIL() << "it was built";
  } catch (const InputError& error) {
    const std::string text = error.what(), first = text.substr(0, text.find('\n'));
    for (const std::string& words : {std::string("clBuildProgram"), device.entry.name,
                                     std::string("CL_BUILD_PROGRAM_FAILURE")})
      EXPECT_NE(first.find(words), std::string::npos) << first;
    EXPECT_NE(text.find("no_such_name"), std::string::npos) << text;
  }
}

TEST_F(OpenClPrograms, without_the_kernel_asked_for_say_so) {
  opencl::Queue queue(device);
  const opencl::Program program = opencl::build_program(device, doubling_source());
  try {
    queue.make_kernel(program, "halved");
    FAIL() << "it was made";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("kernel halved"), std::string::npos) << text;
    EXPECT_NE(text.find("CL_INVALID_KERNEL_NAME"), std::string::npos) << text;
  }
}

} // namespace
} // namespace dss::test
