/// The variant `mpi`: several ranks, each with the executor of another variant. Without mpirun
/// there is one rank.
#include "variants/mpi/distributed_executor.hpp"

namespace dss {
namespace {

std::unique_ptr<Executor> create(const Setup& setup) {
  return std::make_unique<DistributedExecutor>(setup);
}

void end(int exit_code, bool is_in_order) {
  if (World::is_started()) World::instance().end(exit_code, is_in_order);
}

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() {
  static constexpr dss::Plugin plugin{dss::plugin_abi, DSS_VARIANT, DSS_ISA, true, true, true,
                                      dss::create,     nullptr,     dss::end};
  return &plugin;
}
