#pragma once
/// Devices that a variant computes on, beside the program's own processor.
#include "solver/model/model.hpp"

#include <string>
#include <vector>

namespace dss {

/// One device as a variant found it.
struct DeviceEntry {
  std::string id;   ///< "0:1": platform and device, as --device takes it
  std::string kind; ///< "cpu", "gpu", "accelerator"
  std::string name, platform, version;
  int compute_units = 0;
  double memory_bytes = 0, largest_buffer_bytes = 0;
  bool has_f64 = false;
  std::string unusable; ///< empty, or why it cannot be used
};

/// The device meant by the text of --device: "0:1" (platform and device), "gpu", "cpu" or "accelerator" (the first of its kind), else a part
/// of the name of a device or platform, in any case; empty: the first that can be used, of the kinds gpu, accelerator, cpu in this order.
/// @throws InputError if there is none, or the one that is meant cannot be used
const DeviceEntry& choose_device(const std::vector<DeviceEntry>& devices, const std::string& text);
/// @throws InputError if `precision` is f64 and the device has no double precision
void require_precision(const DeviceEntry& device, Precision precision);

/// What a device can do at best, as measured.
struct DeviceCeilings {
  double triad_bytes_per_s = 0;                    ///< memory bandwidth
  double f64_flops_per_s = 0, f32_flops_per_s = 0; ///< fused multiply-adds, two each; 0: it lacks the precision
};

/// What an executor used of a device. Counts and times are of all calls of advance.
struct DeviceUse {
  DeviceEntry device;
  double build_s = 0;     ///< making the program ready: compilation, or reading it from the cache [s]
  bool is_cached = false; ///< no program was compiled
  double launches = 0;
  double to_device_bytes = 0, from_device_bytes = 0;
  double transfer_s = 0; ///< in transfers, hidden or not [s]
  double launch_s = 0;   ///< one empty launch and its end, as measured once on this device [s]
  /// Adds counts and times; the device is the first that is known.
  DeviceUse& operator+=(const DeviceUse& other);
};

} // namespace dss
