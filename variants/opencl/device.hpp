#pragma once
/// The OpenCL devices of this machine.
#include "solver/model/model.hpp"
#include "variants/device.hpp"
#include "variants/opencl/opencl.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace dss::opencl {

/// A device, and what decides how a program is laid out on it.
struct Device {
  cl::Device handle;
  DeviceEntry entry;
  bool is_cpu = false;
  bool is_unified = false; ///< shares the host's memory: mapping copies nothing
  bool is_correctly_rounded_f32 = false;
  int compute_units = 1;
  int width_f64 = 1, width_f32 = 1; ///< lanes of its native vectors; 1 on GPUs

  int vector_width(Precision precision) const { return precision == Precision::f64 ? width_f64 : width_f32; }
};

/// Whether DSSBENCH_OPENCL_AS asks that a CPU device be taken for something else, to test that path: "gpu" (work-groups of lanes, memory of
/// its own) or "discrete" (memory of its own).
bool is_taken_for(std::string_view kind);

/// Every device of every platform; empty without a platform. Those that cannot be used say why. No errors.
std::vector<DeviceEntry> devices();

/// Empty if there is a usable device, else why not.
std::string why_unusable();

/// The device meant by `text`, as choose_device says.
/// @throws InputError if there is none, it cannot be used, or it lacks double precision where `precision` is f64
Device find_device(const std::string& text, Precision precision);

/// The first compute units of a CPU device, so that its runtime leaves the other processors to whoever computes beside it; the whole device
/// where it cannot be divided, and GPUs always.
Device narrowed(const Device& device, int compute_units);

} // namespace dss::opencl
