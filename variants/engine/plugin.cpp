/// Entry point of every module that consists of the row engine. CMake defines DSS_VARIANT and
/// DSS_ISA.
#include "variants/engine/compiled_kernels.hpp"
#include "variants/engine/row_executor.hpp"

extern "C" const dss::Plugin* dss_plugin() {
#ifdef __FMA__
  constexpr bool has_fma = true;
#else
  constexpr bool has_fma = false;
#endif
  static constexpr dss::Plugin plugin{
      dss::plugin_abi,          DSS_VARIANT,          DSS_ISA, has_fma, true, false,
      dss::create_row_executor, dss::compiled_kernels};
  return &plugin;
}
