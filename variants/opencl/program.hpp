#pragma once
/// OpenCL programs: built once in a process; binaries are kept for later processes.
#include "variants/opencl/device.hpp"

#include <string>

namespace dss::opencl {

/// The context of a device. A process has one for each device, so that programs can be shared.
/// @throws InputError if the driver fails
const cl::Context& context_of(const Device& device);

/// A program that is ready to run.
struct Program {
  cl::Program handle;
  double build_s = 0; ///< time of this call to make it ready [s]
  /// Nothing was compiled: this process has built it before, or an earlier process left its binary.
  bool is_cached = false;
};

/// Builds a program for one device. Denormals are flushed; f32 divisions and roots are rounded
/// correctly if the device can. FP_CONTRACT OFF is in the source. Binaries are kept in
/// cache_directory() if it can be written; PoCL's only if $DSSBENCH_CACHE_DIR is set, since PoCL
/// has a cache of its own. A binary that is damaged or that the driver refuses is built anew.
/// Threads and processes may call this at the same time.
/// @param options  further options: "-DREAL=double8"
/// @throws InputError if the source does not compile: one line that says where, then the compiler's
///   log
Program build_program(const Device& device, const std::string& source,
                      const std::string& options = "");

} // namespace dss::opencl
