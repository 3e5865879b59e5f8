/// Which device the text of --device selects, on machines that tests do not have.
#include "solver/error.hpp"
#include "variants/api/device.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

DeviceEntry entry(const std::string& id, const std::string& kind, const std::string& name,
                  const std::string& platform, const std::string& unusable = "") {
  DeviceEntry device;
  device.id = id;
  device.kind = kind;
  device.name = name;
  device.platform = platform;
  device.has_f64 = kind != "accelerator";
  device.unusable = unusable;
  return device;
}

const std::vector<DeviceEntry>& machine() {
  static const std::vector<DeviceEntry> devices = {
      entry("0:0", "cpu", "pthread-haswell", "Portable Computing Language"),
      entry("1:0", "gpu", "Old GPU", "Vendor", "it has OpenCL 1.1, not 1.2"),
      entry("1:1", "gpu", "New GPU", "Vendor"),
      entry("2:0", "accelerator", "Board", "Other"),
  };
  return devices;
}

std::string refusal(const std::vector<DeviceEntry>& devices, const std::string& text) {
  try {
    return "found " + choose_device(devices, text).id;
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(DeviceChoice, without_a_name_takes_the_first_usable_gpu_then_accelerator_then_cpu) {
  std::vector<DeviceEntry> devices = machine();
  EXPECT_EQ(choose_device(devices, "").id, "1:1");
  devices.erase(devices.begin() + 2);
  EXPECT_EQ(choose_device(devices, "").id, "2:0");
  devices.pop_back();
  EXPECT_EQ(choose_device(devices, "").id, "0:0");
}

TEST(DeviceChoice, takes_a_number_a_kind_or_a_part_of_a_name_in_any_case) {
  for (const auto& [text, id] : {std::pair{"0:0", "0:0"},
                                 {"1:1", "1:1"},
                                 {"gpu", "1:1"},
                                 {"CPU", "0:0"},
                                 {"HASWELL", "0:0"},
                                 {"portable", "0:0"},
                                 {"vendor", "1:1"},
                                 {"board", "2:0"}})
    EXPECT_EQ(choose_device(machine(), text).id, id) << text;
}

TEST(DeviceChoice, says_why_the_one_that_is_meant_cannot_be_used) {
  EXPECT_EQ(refusal(machine(), "1:0"),
            "--device 1:0: device 1:0 (Old GPU) cannot be used: it has OpenCL 1.1, not 1.2");
  EXPECT_EQ(refusal(machine(), "old"),
            "--device old: device 1:0 (Old GPU) cannot be used: it has OpenCL 1.1, not 1.2");
}

TEST(DeviceChoice, names_the_known_ones_and_the_nearest) {
  const std::string text = refusal(machine(), "New GPUs");
  for (const char* words :
       {"--device New GPUs: no such device", "did you mean \"New GPU\"", "0:0", "2:0", "Board"})
    EXPECT_NE(text.find(words), std::string::npos) << text;
  EXPECT_NE(refusal({machine().front()}, "gpu").find("no such device; known"),
            std::string::npos); // does not mention the cpu
  EXPECT_EQ(refusal({}, "gpu").find("--device gpu: no OpenCL device here"), 0u);
}

TEST(DeviceChoice, refuses_double_precision_where_there_is_none) {
  EXPECT_NO_THROW(require_precision(choose_device(machine(), "cpu"), Precision::f64));
  EXPECT_NO_THROW(require_precision(choose_device(machine(), "board"), Precision::f32));
  EXPECT_THROW(require_precision(choose_device(machine(), "board"), Precision::f64), InputError);
}

} // namespace
} // namespace dss::test
