/// The variant `mpi`: several ranks, each with the executor of another variant. Without mpirun
/// there is one rank.
#include "variants/mpi/distributed_executor.hpp"
#include "variants/mpi/distributed_members.hpp"

namespace dss {
namespace {

std::unique_ptr<Executor> create(const Setup& setup) {
  if (setup.ensemble != nullptr) return std::make_unique<DistributedMembers>(setup);
  return std::make_unique<DistributedExecutor>(setup);
}

void end(int exit_code, bool is_in_order) {
  if (World::is_started()) World::instance().end(exit_code, is_in_order);
}

} // namespace
} // namespace dss

extern "C" const dss::Plugin* dss_plugin() {
  static constexpr dss::Plugin plugin{.abi = dss::plugin_abi,
                                      .name = DSS_VARIANT,
                                      .isa = DSS_ISA,
                                      .has_fma = true,
                                      .is_threaded = true,
                                      .is_distributed = true,
                                      .create = dss::create,
                                      .kernels = nullptr,
                                      .end = dss::end,
                                      .has_pressure = true,
                                      .has_rotating_frame = true,
                                      .has_mass_ratios = true,
                                      .has_tiles = true,
                                      .ensemble_lanes = dss::members_of_ranks};
  return &plugin;
}
