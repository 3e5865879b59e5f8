#pragma once
/// Measures the peak rates of a device, which are the bounds of its roofline.
#include "variants/api/device.hpp"

#include <string>

namespace dss::opencl {

/// Measures memory bandwidth with a triad (a = b + s c) over buffers much larger than any cache,
/// and arithmetic with fused multiply-adds in independent chains. CPU devices compute on vectors.
/// The best of several timings counts. Takes one or two seconds.
/// @param device  as for --device
/// @throws InputError if there is no such device, it has too little memory, or its driver fails
DeviceCeilings measure_ceilings(const std::string& device);

} // namespace dss::opencl
