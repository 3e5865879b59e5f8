#include "variants/mpi/distributed_part.hpp"

#include "solver/error.hpp"
#include "variants/part_cost.hpp"

#include <fmt/format.h>

namespace dss {

DistributedPart::DistributedPart(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                                 const HaloStrategy& strategy, World& world, const Fault& fault)
    : part_(make_part(setup.problem, decomposition, world.rank(), halo_depth(strategy, setup.method))),
      exchange_(make_exchange(strategy.transport, faces_of(part_), world.comm())), halo_(*exchange_) {
  if (fault.kind != Fault::Kind::none) faulty_halo_.emplace(halo_, fault);
  Halo& halo = faulty_halo_ ? static_cast<Halo&>(*faulty_halo_) : halo_;
  part_setup_.emplace(PartSetup{part_, halo, strategy.is_every_stage, strategy.is_overlapped});
  executor_ = plugin.create({part_.problem, setup.method, setup.model, setup.precision, setup.dt, setup.threads,
                             &*part_setup_, nullptr, setup.device});
  if (executor_->halo_copies() == 0 && world.ranks() > 1)
    throw InputError(
        fmt::format("variant mpi:{}: {} does not compute parts; give one that does", plugin.name, plugin.name));
  exchange_->attach(executor_->halo_copies(), [this](const Face& face, Way way, int copy) {
    const Neighbour& neighbour = part_.neighbours[face.number];
    return executor_->halo_layout(way == Way::out ? neighbour.send : neighbour.receive, copy);
  });
}

Outcome DistributedPart::advance(long steps, std::span<const double> signals) {
  if (faulty_halo_) faulty_halo_->start();
  const Traffic before = exchange_->traffic();
  const double before_s = halo_.total_s();
  const Outcome outcome = executor_->advance(steps, signals);
  traffic_.messages += exchange_->traffic().messages - before.messages;
  traffic_.bytes += exchange_->traffic().bytes - before.bytes;
  traffic_.wait_s += halo_.total_s() - before_s;
  return outcome;
}

} // namespace dss
