#pragma once
/// OpenCL 1.2 through Khronos' C++ bindings. Their exceptions become the program's own.
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>

#include <string>
#include <string_view>

namespace dss::opencl {

/// Name of a status, for example "CL_INVALID_VALUE"; "OpenCL status -9999" if OpenCL 1.2 does not
/// define it.
std::string status_name(cl_int status);

/// @throws InputError always: "opencl: clFinish on NAME: CL_OUT_OF_RESOURCES: what would be right"
[[noreturn]] void fail(std::string_view device, const cl::Error& error);

/// Returns what body() returns. The bindings check every cl_int, and every error becomes the
/// InputError of fail().
template <class Body>
decltype(auto) guarded(std::string_view device, Body&& body) {
  try {
    return body();
  } catch (const cl::Error& error) {
    fail(device, error);
  }
}

} // namespace dss::opencl
