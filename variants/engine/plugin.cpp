/// Entry point of every module that consists of the row engine. CMake defines DSS_VARIANT and
/// DSS_ISA.
#include "kernels/simd/simd.hpp"
#include "variants/engine/compiled_kernels.hpp"
#include "variants/engine/row_executor.hpp"

/// Members of an ensemble lie in the lanes of packs.
static int ensemble_lanes(dss::Precision precision, const dss::Distribution&) {
  return dss::is_single(precision) ? dss::simd::lanes<float> : dss::simd::lanes<double>;
}

extern "C" const dss::Plugin* dss_plugin() {
  static constexpr dss::Plugin plugin{.abi = dss::plugin_abi,
                                      .name = DSS_VARIANT,
                                      .isa = DSS_ISA,
                                      .has_fma = dss::simd::has_fma,
                                      .is_threaded = true,
                                      .is_distributed = false,
                                      .create = dss::create_row_executor,
                                      .kernels = dss::compiled_kernels,
                                      .has_pressure = true,
                                      .has_rotating_frame = true,
                                      .has_mass_ratios = true,
                                      .has_tiles = true,
                                      .ensemble_lanes = ensemble_lanes};
  return &plugin;
}
