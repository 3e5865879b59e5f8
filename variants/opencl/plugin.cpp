/// Entry point of the variants `opencl` and `opencl-rhs`. CMake defines DSS_OPENCL_EXECUTOR, the
/// executor of each.
#include "variants/api/api.hpp"
#include "variants/opencl/ceilings.hpp"
#include "variants/opencl/resident_executor.hpp"
#include "variants/opencl/rhs_executor.hpp"

namespace dss {
namespace {

template <class T>
std::unique_ptr<Executor> create_for(const Setup& setup, const opencl::Device& device,
                                     const opencl::Layout& layout) {
  return opencl::with_lanes<T>(layout.lanes, [&](auto lanes) -> std::unique_ptr<Executor> {
    return std::make_unique<opencl::DSS_OPENCL_EXECUTOR<T, lanes>>(setup, device, layout);
  });
}

std::unique_ptr<Executor> create(const Setup& setup) {
  const opencl::Device device =
      opencl::narrowed(opencl::find_device(setup.device, setup.precision), setup.threads);
  const opencl::Layout layout = opencl::layout_on(device, setup.precision, setup.threads);
  if (is_single(setup.precision)) return create_for<float>(setup, device, layout);
  return create_for<double>(setup, device, layout);
}

constexpr Plugin plugin = {.abi = plugin_abi,
                           .name = DSS_VARIANT,
                           .isa = "OpenCL C 1.2",
                           .has_fma = true,
                           .is_threaded = true,
                           .is_distributed = false,
                           .create = create,
                           .kernels = nullptr,
                           .why_unusable = opencl::why_unusable,
                           .devices = opencl::devices,
                           .ceilings = opencl::measure_ceilings,
                           .has_pressure = true,
                           .has_rotating_frame = true,
                           .has_mass_ratios = true,
                           .has_tiles = true};

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() { return &dss::plugin; }
