#include "variants/opencl/program.hpp"
#include "solver/error.hpp"
#include "variants/opencl/binary_cache.hpp"

#include <chrono>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace dss::opencl {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string all_options(const Device& device, const std::string& options) {
  return fmt::format("-cl-std=CL1.2 -cl-denorms-are-zero{} {}",
                     device.is_correctly_rounded_f32 ? " -cl-fp32-correctly-rounded-divide-sqrt" : "", options);
}

/// Everything that the binary depends on.
std::string key_of(const Device& device, const std::string& source, const std::string& options) {
  const DeviceEntry& entry = device.entry;
  const cl::Platform platform(device.handle.getInfo<CL_DEVICE_PLATFORM>());
  return fmt::format("{}\n{}\n{}\n{}\n{}", entry.name, entry.version, platform.getInfo<CL_PLATFORM_VERSION>(), options,
                     source);
}

[[noreturn]] void fail_to_compile(const Device& device, const cl::BuildError& error) {
  std::string log;
  for (const auto& [of_device, text] : error.getBuildLog()) log += text;
  throw InputError(fmt::format("opencl: {} on {}: {}: its compiler refuses the kernels; its log:\n{}", error.what(),
                               device.entry.name, status_name(error.err()), log));
}

/// Nothing if there is no binary or the driver, perhaps a newer one, refuses it.
std::optional<cl::Program> built_from_binary(const Device& device, const std::string& key, const std::string& options) {
  const std::optional<std::string> binary = load_binary(key);
  if (!binary) return std::nullopt;
  try {
    cl::Program program(context_of(device), {device.handle}, {{binary->begin(), binary->end()}});
    program.build({device.handle}, options.c_str());
    return program;
  } catch (const cl::Error&) {
    return std::nullopt;
  }
}

cl::Program built_from_source(const Device& device, const std::string& source, const std::string& options) {
  try {
    cl::Program program(context_of(device), source);
    program.build({device.handle}, options.c_str());
    return program;
  } catch (const cl::BuildError& error) {
    fail_to_compile(device, error);
  }
}

void keep_binary(const cl::Program& program, const std::string& key) {
  for (const std::vector<unsigned char>& binary : program.getInfo<CL_PROGRAM_BINARIES>()) // of the one device
    store_binary(key, {reinterpret_cast<const char*>(binary.data()), binary.size()});
}

/// Never destroyed: drivers may have ended before the destructors of static objects run.
template <class Map>
Map& kept_until_the_end() {
  static Map& map = *new Map;
  return map;
}

std::mutex contexts_mutex, programs_mutex;

} // namespace

const cl::Context& context_of(const Device& device) {
  const std::lock_guard lock(contexts_mutex);
  auto& contexts = kept_until_the_end<std::map<cl_device_id, cl::Context>>();
  const auto known = contexts.find(device.handle());
  if (known != contexts.end()) return known->second;
  return guarded(device.entry.name, [&]() -> const cl::Context& {
    return contexts.emplace(device.handle(), cl::Context(device.handle)).first->second;
  });
}

Program build_program(const Device& device, const std::string& source, const std::string& options) {
  const auto start = Clock::now();
  const std::lock_guard lock(programs_mutex);
  auto& programs = kept_until_the_end<std::map<std::pair<cl_device_id, std::string>, cl::Program>>();
  return guarded(device.entry.name, [&]() -> Program {
    const std::string full_options = all_options(device, options);
    const std::string key = key_of(device, source, full_options);
    cl::Program& program = programs[{device.handle(), key}];
    if (program() != nullptr) return {program, seconds_since(start), true};
    if (const auto cached = built_from_binary(device, key, full_options)) {
      program = *cached;
      return {program, seconds_since(start), true};
    }
    program = built_from_source(device, source, full_options);
    keep_binary(program, key);
    return {program, seconds_since(start), false};
  });
}

} // namespace dss::opencl
