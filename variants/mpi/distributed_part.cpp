#include "variants/mpi/distributed_part.hpp"

#include "solver/error.hpp"
#include "variants/cost/part_cost.hpp"
#include "variants/mpi/transports.hpp"
#include "variants/mpi/waiting.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {

DistributedPart::DistributedPart(const Setup& setup, const Plugin& plugin,
                                 const Decomposition& decomposition, const HaloStrategy& strategy,
                                 World& world, const Fault& fault)
    : part_(make_part(setup.problem, decomposition, world.rank(),
                      halo_depth(strategy, {setup.method, setup.problem}))),
      exchange_(make_exchange(strategy.transport, faces_of(part_), world.comm())),
      halo_(*exchange_, [&world](bool is_alone) { world.work_alone(is_alone); }) {
  if (fault.kind != Fault::Kind::none) faulty_halo_.emplace(halo_, fault);
  Halo& halo = faulty_halo_ ? static_cast<Halo&>(*faulty_halo_) : halo_;
  part_setup_.emplace(PartSetup{part_, halo, strategy.is_every_stage, strategy.is_overlapped});
  executor_ = plugin.create({part_.problem, setup.method, setup.model, setup.precision, setup.dt,
                             setup.threads, &*part_setup_, nullptr, setup.device});
  if (halo_copies(*executor_) == 0 && world.ranks() > 1)
    throw InputError(fmt::format("variant mpi:{}: {} does not compute parts; give one that does",
                                 plugin.name, plugin.name));
  const std::size_t bytes = number_bytes(setup.precision);
  const auto lanes = world.gather(halo_lanes(*executor_));
  const bool is_mixed = are_mixed(lanes);
  const std::vector<MessageOrder> orders =
      is_mixed ? neighbours_orders(bytes, world.comm()) : std::vector<MessageOrder>{};
  exchange_->attach(halo_copies(*executor_), [&](const Face& face, Way way, int copy) {
    const Neighbour& neighbour = part_.neighbours[face.number];
    HaloLayout layout =
        halo_layout(*executor_, way == Way::out ? neighbour.send : neighbour.receive, copy);
    if (!is_mixed || way == Way::out) return layout;
    return reordered(layout, message_order(*executor_, neighbour.receive, copy, bytes),
                     orders[face.number], bytes);
  });
}

/// Receives from each neighbour how it orders its messages to this rank.
std::vector<MessageOrder> DistributedPart::neighbours_orders(std::size_t number_bytes,
                                                             MPI_Comm comm) {
  std::vector<MessageOrder> own, theirs;
  std::vector<MPI_Request> requests;
  for (const Neighbour& neighbour : part_.neighbours)
    own.push_back(message_order(*executor_, neighbour.send, 0, number_bytes));
  for (std::size_t n = 0; n < own.size(); ++n)
    MPI_Isend(own[n].data(), count_of(own[n].size()), MPI_UNSIGNED_LONG, part_.neighbours[n].part,
              0, comm, &requests.emplace_back());
  for (const Neighbour& neighbour : part_.neighbours) {
    theirs.emplace_back(halo_layout(*executor_, neighbour.receive, 0).size / number_bytes);
    const Waiting waiting(neighbour.part);
    MPI_Recv(theirs.back().data(), count_of(theirs.back().size()), MPI_UNSIGNED_LONG,
             neighbour.part, 0, comm, MPI_STATUS_IGNORE);
  }
  const Waiting waiting(Waiting::for_all);
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return theirs;
}

template <class Work>
auto DistributedPart::counted(Work&& work) {
  if (faulty_halo_) faulty_halo_->start();
  const Traffic before = exchange_->traffic();
  const double before_s = halo_.total_s();
  const auto result = work();
  traffic_.messages += exchange_->traffic().messages - before.messages;
  traffic_.bytes += exchange_->traffic().bytes - before.bytes;
  traffic_.wait_s += halo_.total_s() - before_s;
  return result;
}

Outcome DistributedPart::advance(long steps, std::span<const double> signals) {
  return counted([&] { return executor_->advance(steps, signals); });
}

StepMaxima DistributedPart::try_step(double dt, std::span<const double> signals) {
  return counted([&] { return adaptive(*executor_).try_step(dt, signals); });
}

} // namespace dss
