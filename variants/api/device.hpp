#pragma once
/// Devices: processors that a variant computes on instead of the program's own CPU threads.
#include "kernels/model.hpp"

#include <string>
#include <vector>

namespace dss {

/// One device as a variant found it.
struct DeviceEntry {
  std::string id;   ///< "PLATFORM:DEVICE", for example "0:1", as --device takes it
  std::string kind; ///< "cpu", "gpu", "accelerator"
  std::string name, platform, version;
  int compute_units = 0;
  double memory_bytes = 0, largest_buffer_bytes = 0;
  bool has_f64 = false;
  std::string unusable; ///< empty, or the reason why it cannot be used
};

/// Chooses the device that the text of --device names.
/// @param devices  all devices that were found
/// @param text     "0:1" (platform and device); "gpu", "cpu" or "accelerator" (the first of this
/// kind); else a part of the name of a device or platform, in upper or lower case. Empty: the first
/// usable device; a gpu is preferred to an accelerator, and that to a cpu.
/// @throws InputError if no device matches, or the chosen device is not usable
const DeviceEntry& choose_device(const std::vector<DeviceEntry>& devices, const std::string& text);
/// @throws InputError if `precision` is f64 and the device has no double precision
void require_precision(const DeviceEntry& device, Precision precision);

/// Peak rates of a device, as measured.
struct DeviceCeilings {
  double triad_bytes_per_s = 0; ///< memory bandwidth
  /// Fused multiply-adds count as two flops. 0: the device lacks this precision.
  double f64_flops_per_s = 0, f32_flops_per_s = 0;
};

/// What an executor used of a device. Counts and times are sums over all calls of advance.
struct DeviceUse {
  DeviceEntry device;
  double build_s = 0;     ///< time to compile the program or to read it from the cache [s]
  bool is_cached = false; ///< no program had to be compiled
  double launches = 0;
  double to_device_bytes = 0, from_device_bytes = 0;
  double transfer_s = 0; ///< time in transfers, including those hidden behind computation [s]
  double launch_s = 0;   ///< one empty launch and its end, measured once on this device [s]
  /// Adds counts and times. Keeps its own device if it has one.
  DeviceUse& operator+=(const DeviceUse& other);
};

} // namespace dss
