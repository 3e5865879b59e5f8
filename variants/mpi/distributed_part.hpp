#pragma once
/// One rank's part under one halo strategy, ready to compute. Used for runs and for trials of
/// strategies.
#include "variants/api/api.hpp"
#include "variants/api/message_order.hpp"
#include "variants/mpi/faults.hpp"
#include "variants/mpi/halo_exchange.hpp"
#include "variants/mpi/world.hpp"

#include <memory>
#include <optional>

namespace dss {

/// A part with its executor and its exchange of halos.
class DistributedPart {
public:
  /// Collective.
  /// @param setup  of the whole problem
  /// @throws InputError if the variant cannot compute parts
  DistributedPart(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                  const HaloStrategy& strategy, World& world, const Fault& fault);
  DistributedPart(const DistributedPart&) = delete;
  DistributedPart& operator=(const DistributedPart&) = delete;

  /// Advances this part only: the outcome of other ranks may differ. Elements have local numbers.
  Outcome advance(long steps, std::span<const double> signals);
  StepMaxima try_step(double dt, std::span<const double> signals);
  const Part& part() const { return part_; }
  Executor& executor() { return *executor_; }
  const Executor& executor() const { return *executor_; }
  /// What this rank exchanged in all calls of advance.
  const Traffic& traffic() const { return traffic_; }

private:
  /// Calls `work`, which exchanges halos, and adds messages, bytes and time to traffic_.
  template <class Work>
  auto counted(Work&& work);
  std::vector<MessageOrder> neighbours_orders(std::size_t number_bytes, MPI_Comm comm);

  const Part part_;
  const std::unique_ptr<HaloExchange> exchange_;
  TimedHalo halo_;
  /// Set for faults on purpose; the executor then calls it, and it calls halo_.
  std::optional<FaultyHalo> faulty_halo_;
  std::optional<PartSetup> part_setup_;
  std::unique_ptr<Executor> executor_;
  Traffic traffic_;
};

} // namespace dss
