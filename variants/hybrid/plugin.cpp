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
  static const dss::Plugin plugin{dss::plugin_abi,    DSS_VARIANT, DSS_ISA,
                                  dss::has_fma(),     true,        false,
                                  dss::create_hybrid, nullptr};
  return &plugin;
}
