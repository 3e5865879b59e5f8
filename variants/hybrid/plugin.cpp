/// The variant `hybrid`: several members compute one scene at once, or the fastest executor alone.
#include "solver/error.hpp"
#include "variants/hybrid/hybrid.hpp"
#include "variants/loading/loader.hpp"

namespace dss {
namespace {

/// Whether the variant that all choices start from has FMA.
bool has_fma() {
  try {
    return load_variant("auto").has_fma;
  } catch (const InputError&) {
    return false;
  }
}

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() {
  static const dss::Plugin plugin{.abi = dss::plugin_abi,
                                  .name = DSS_VARIANT,
                                  .isa = DSS_ISA,
                                  .has_fma = dss::has_fma(),
                                  .is_threaded = true,
                                  .is_distributed = false,
                                  .create = dss::create_hybrid,
                                  .kernels = nullptr,
                                  .has_pressure = true,
                                  .has_rotating_frame = true,
                                  .has_mass_ratios = true,
                                  .has_tiles = true};
  return &plugin;
}
