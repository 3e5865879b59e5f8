#include "variants/opencl/device.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <utility>

namespace dss::opencl {
namespace {

constexpr const char* no_platform =
    "no OpenCL platform; install one: pocl-opencl-icd for the CPU, or the driver of the GPU";

std::vector<cl::Platform> platforms() {
  std::vector<cl::Platform> found;
  try {
    cl::Platform::get(&found);
  } catch (const cl::Error&) { // no platform at all: the loader reports it as an error
  }
  return found;
}

std::vector<cl::Device> devices_of(const cl::Platform& platform) {
  std::vector<cl::Device> found;
  try {
    platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
  } catch (const cl::Error&) { // a platform without devices reports an error too
  }
  return found;
}

/// Removes the blanks and zeros that drivers append to names.
std::string trimmed(std::string text) {
  constexpr std::string_view blanks(" \t\n\0", 4);
  text.erase(text.find_last_not_of(blanks) + 1);
  text.erase(0, text.find_first_not_of(blanks));
  return text;
}

const char* kind_of(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_GPU) return "gpu";
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  return "accelerator";
}

std::string why_device_unusable(const cl::Device& device, const std::string& version) {
  int major = 0, minor = 0;
  std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor); // the standard fixes this layout
  if (major < 1 || (major == 1 && minor < 2)) return fmt::format("it has {}, not 1.2", version);
  if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "its driver says that it is not available";
  if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "its driver has no compiler";
  return {};
}

DeviceEntry entry_of(const cl::Platform& platform, const cl::Device& device,
                     const std::string& id) {
  DeviceEntry entry;
  entry.id = id;
  try {
    entry.kind = kind_of(device.getInfo<CL_DEVICE_TYPE>());
    entry.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    entry.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    const std::string version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    entry.version =
        fmt::format("{}, driver {}", version, trimmed(device.getInfo<CL_DRIVER_VERSION>()));
    entry.compute_units = int(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    entry.memory_bytes = double(device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>());
    entry.largest_buffer_bytes = double(device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>());
    entry.has_f64 = device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() != 0;
    entry.unusable = why_device_unusable(device, version);
  } catch (const cl::Error& error) {
    entry.unusable = fmt::format("{}: {}", error.what(), status_name(error.err()));
  }
  return entry;
}

/// Calls visit(entry, device) for every device, in the order of their ids.
template <class Visit>
void each_device(Visit&& visit) {
  const std::vector<cl::Platform> all = platforms();
  for (std::size_t p = 0; p < all.size(); ++p) {
    const std::vector<cl::Device> of_platform = devices_of(all[p]);
    for (std::size_t d = 0; d < of_platform.size(); ++d)
      visit(entry_of(all[p], of_platform[d], fmt::format("{}:{}", p, d)), of_platform[d]);
  }
}

} // namespace

bool is_taken_for(std::string_view kind) {
  const char* const asked = std::getenv("DSSBENCH_OPENCL_AS");
  return asked != nullptr && kind == asked;
}

std::vector<DeviceEntry> devices() {
  std::vector<DeviceEntry> list;
  each_device([&](DeviceEntry entry, const cl::Device&) { list.push_back(std::move(entry)); });
  return list;
}

std::string why_unusable() {
  if (platforms().empty()) return no_platform;
  try {
    choose_device(devices(), "");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

Device find_device(const std::string& text, Precision precision) {
  if (platforms().empty()) throw InputError(no_platform);
  Device device;
  device.entry = choose_device(devices(), text);
  require_precision(device.entry, precision);
  each_device([&](const DeviceEntry& entry, const cl::Device& handle) {
    if (entry.id == device.entry.id) device.handle = handle;
  });
  return guarded(device.entry.name, [&] {
    const cl::Device& handle = device.handle;
    device.is_cpu = device.entry.kind == "cpu";
    device.is_unified =
        handle.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != 0 && !is_taken_for("discrete");
    device.compute_units = std::max(1, device.entry.compute_units);
    device.is_correctly_rounded_f32 =
        (handle.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    // 0: no double precision.
    device.width_f64 = std::max(1, int(handle.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE>()));
    device.width_f32 = std::max(1, int(handle.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>()));
    return device;
  });
}

Device narrowed(const Device& device, int compute_units) {
  if (!device.is_cpu || compute_units >= device.compute_units) return device;
  static std::mutex mutex;
  // Never destroyed: drivers may end before statics do.
  static auto& known = *new std::map<std::pair<cl_device_id, int>, cl::Device>;
  const std::lock_guard lock(mutex);
  Device part = device;
  part.compute_units = compute_units;
  if (const auto found = known.find({device.handle(), compute_units}); found != known.end()) {
    part.handle = found->second;
    return part;
  }
  try {
    const cl_device_partition_property counts[] = {CL_DEVICE_PARTITION_BY_COUNTS, compute_units,
                                                   CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    cl::Device handle = device.handle;
    handle.createSubDevices(counts, &parts);
    part.handle = parts.front();
  } catch (const cl::Error&) { // then its runtime uses all processors
    part.handle = device.handle;
  }
  known.emplace(std::pair{device.handle(), compute_units}, part.handle);
  return part;
}

} // namespace dss::opencl
