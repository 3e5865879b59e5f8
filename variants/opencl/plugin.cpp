#include "solver/error.hpp"
#include "variants/api.hpp"
#include "variants/opencl/ceilings.hpp"
#include "variants/opencl/device.hpp"

namespace dss {
namespace {

std::unique_ptr<Executor> create(const Setup& setup) {
  opencl::find_device(setup.device, setup.precision);
  throw InputError("variant " DSS_VARIANT ": not built yet");
}

constexpr Plugin plugin = {.abi = plugin_abi,
                           .name = DSS_VARIANT,
                           .isa = "OpenCL C 1.2",
                           .has_fma = true,
                           .is_threaded = false,
                           .is_distributed = false,
                           .create = create,
                           .kernels = nullptr,
                           .why_unusable = opencl::why_unusable,
                           .devices = opencl::devices,
                           .ceilings = opencl::measure_ceilings};

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() { return &dss::plugin; }
