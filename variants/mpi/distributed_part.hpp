#pragma once
/// One rank's part under one strategy, ready to compute: for a run, and for the trial of a strategy.
#include "variants/api.hpp"
#include "variants/message_order.hpp"
#include "variants/mpi/faults.hpp"
#include "variants/mpi/halo_exchange.hpp"
#include "variants/mpi/world.hpp"

#include <memory>
#include <optional>

namespace dss {

class DistributedPart {
public:
  /// Collective. @param setup  of the whole problem  @throws InputError if the variant computes no parts
  DistributedPart(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                  const HaloStrategy& strategy, World& world, const Fault& fault);
  DistributedPart(const DistributedPart&) = delete;
  DistributedPart& operator=(const DistributedPart&) = delete;

  /// Of this part: a state that fails is this rank's own.
  Outcome advance(long steps, std::span<const double> signals);
  StepMaxima try_step(double dt, std::span<const double> signals);
  const Part& part() const { return part_; }
  Executor& executor() { return *executor_; }
  const Executor& executor() const { return *executor_; }
  /// In all calls of advance.
  const Traffic& traffic() const { return traffic_; }

private:
  /// Does what exchanges halos, and counts what it takes.
  template <class Work>
  auto counted(Work&& work);
  std::vector<MessageOrder> neighbours_orders(std::size_t number_bytes, MPI_Comm comm);

  const Part part_;
  const std::unique_ptr<HaloExchange> exchange_;
  TimedHalo halo_;
  std::optional<FaultyHalo> faulty_halo_; ///< before it, for faults on purpose
  std::optional<PartSetup> part_setup_;
  std::unique_ptr<Executor> executor_;
  Traffic traffic_;
};

} // namespace dss
