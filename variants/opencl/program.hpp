#pragma once
/// OpenCL programs: built once in a process, and kept as binaries between processes.
#include "variants/opencl/device.hpp"

#include <string>

namespace dss::opencl {

/// The context of a device, one in a process, so that its programs can be shared. @throws InputError
const cl::Context& context_of(const Device& device);

struct Program {
  cl::Program handle;
  double build_s = 0;     ///< making it ready in this call [s]
  bool is_cached = false; ///< nothing was compiled: this process has built it before, or an earlier one left its binary
};

/// Builds `source` for one device: flushes denormals, rounds divisions and roots of f32 correctly where the device can; the source itself
/// says FP_CONTRACT OFF. Binaries are kept in $DSSBENCH_CACHE_DIR, else $XDG_CACHE_HOME/dssbench/opencl, else ~/.cache/dssbench/opencl, if
/// that can be written (PoCL keeps its own unless the first is set); a binary that is damaged or that the driver refuses is built anew.
/// Threads and processes may build at once.
/// @param options  further options: "-DREAL=double8"
/// @throws InputError for source that does not compile: one line that says where, then the compiler's log
Program build_program(const Device& device, const std::string& source, const std::string& options = "");

} // namespace dss::opencl
