#pragma once
/// What a device can do at best, measured: the bounds that a roofline compares with.
#include "variants/device.hpp"

#include <string>

namespace dss::opencl {

/// Memory bandwidth by a triad over buffers well beyond any cache, and fused multiply-adds in independent chains, on vectors where the
/// device is a CPU. The best of several timings, a second or two in all.
/// @param device  as for --device
/// @throws InputError if there is no such device, it has too little memory, or its driver fails
DeviceCeilings measure_ceilings(const std::string& device);

} // namespace dss::opencl
