#pragma once
/// The OpenCL devices of this machine.
#include "kernels/model.hpp"
#include "variants/api/device.hpp"
#include "variants/opencl/opencl.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace dss::opencl {

/// A device, and the properties that decide how a program is laid out on it.
struct Device {
  cl::Device handle;
  DeviceEntry entry;
  bool is_cpu = false;
  bool is_unified = false; ///< shares the host's memory, so mapping copies nothing
  bool is_correctly_rounded_f32 = false;
  int compute_units = 1;
  int width_f64 = 1, width_f32 = 1; ///< lanes of its native vectors; 1 on GPUs

  int vector_width(Precision precision) const {
    return precision == Precision::f64 ? width_f64 : width_f32;
  }
};

/// Whether DSSBENCH_OPENCL_AS asks to treat CPU devices as another kind, for tests: "gpu"
/// (work-groups of lanes, memory of its own) or "discrete" (memory of its own).
bool is_taken_for(std::string_view kind);

/// All devices of all platforms; empty if there is no platform. Unusable devices say why. No
/// errors.
std::vector<DeviceEntry> devices();

/// Empty if there is a usable device, else the reason why not.
std::string why_unusable();

/// The device that `text` names (choose_device).
/// @throws InputError if there is none, it is not usable, or `precision` is f64 and it has no
///   double precision
Device find_device(const std::string& text, Precision precision);

/// The first compute units of a CPU device. Its runtime then leaves the other processors to threads
/// that compute beside it. The whole device if it is a GPU or cannot be divided.
Device narrowed(const Device& device, int compute_units);

} // namespace dss::opencl
