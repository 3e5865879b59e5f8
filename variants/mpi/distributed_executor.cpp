#include "variants/mpi/distributed_executor.hpp"

#include "solver/error.hpp"
#include "variants/loader.hpp"
#include "variants/part_cost.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace dss {

const Plugin& DistributedExecutor::find_plugin(const std::string& name) {
  const Plugin& plugin = load_variant(name);
  if (plugin.is_distributed) throw InputError(fmt::format("variant mpi:{}: a part cannot be distributed again", name));
  info_.variant = plugin.name;
  info_.isa = plugin.isa;
  info_.has_fma = plugin.has_fma;
  return plugin;
}

DistributedExecutor::DistributedExecutor(const Setup& asked)
    : world_(World::instance()), fault_(Fault::of_rank(world_.rank())) {
  static const Distribution alone;
  Setup setup = asked;
  if (setup.distribution == nullptr) setup.distribution = &alone;
  const Plugin& plugin = find_plugin(setup.distribution->variant);
  const Spread found = spread(setup, plugin, world_, fault_);
  part_ = make_part(setup.problem, found.decomposition, world_.rank(), halo_depth(*found.halo, setup.method));
  exchange_ = make_exchange(found.halo->transport, faces_of(part_), world_.comm());
  halo_.emplace(*exchange_);
  if (fault_.kind != Fault::Kind::none) faulty_halo_.emplace(*halo_, fault_);
  Halo& halo = faulty_halo_ ? static_cast<Halo&>(*faulty_halo_) : *halo_;
  part_setup_.emplace(PartSetup{part_, halo, found.halo->is_every_stage, found.halo->is_overlapped});
  executor_ = plugin.create(
      {part_.problem, setup.method, setup.model, setup.precision, setup.dt, setup.threads, &*part_setup_});
  if (executor_->halo_copies() == 0 && world_.ranks() > 1)
    throw InputError(
        fmt::format("variant mpi:{}: {} does not compute parts; give one that does", plugin.name, plugin.name));
  exchange_->attach(executor_->halo_copies(), [this](const Face& face, Way way, int copy) {
    const Neighbour& neighbour = part_.neighbours[face.number];
    return executor_->halo_layout(way == Way::out ? neighbour.send : neighbour.receive, copy);
  });
  info_.ranks = world_.ranks();
  info_.decomposition = found.decomposition.method;
  info_.halo = found.halo->name;
  info_.halo_reason = found.halo_reason;
  info_.network = found.network;
  info_.imbalance =
      world_.largest(double(part_.own_elements)) * world_.ranks() / double(setup.problem.lattice.element_count);
  for (const double workers : world_.gather(executor_->workers())) workers_ += int(workers);
  for (const double bytes : world_.gather(double(executor_->bytes()))) bytes_ += std::size_t(bytes);
}

template <class Visit>
void DistributedExecutor::each_own(std::size_t first, std::size_t count, Visit&& visit) const {
  for (const Run& run : part_.runs) {
    const std::size_t begin = std::max(first, run.global), end = std::min(first + count, run.global + run.count);
    if (begin < end) visit(run.local + (begin - run.global), begin, end - begin);
  }
}

std::size_t DistributedExecutor::global_of(std::size_t local) const {
  const auto after = std::upper_bound(part_.runs.begin(), part_.runs.end(), local,
                                      [](std::size_t l, const Run& run) { return l < run.local; });
  const Run& run = *(after - 1);
  return run.global + (local - run.local);
}

void DistributedExecutor::write(std::size_t first, std::span<const double> fields) {
  executor_->write(0, {}); // a method that must stop for it stops on all ranks, whether they own any of these or not
  each_own(first, fields.size() / field_count, [&](std::size_t local, std::size_t global, std::size_t count) {
    executor_->write(local, fields.subspan((global - first) * field_count, count * field_count));
  });
}

void DistributedExecutor::read(std::size_t first, std::span<double> fields) {
  executor_->read(0, {}); // collective for leapfrog
  std::fill(fields.begin(), fields.end(), 0.0);
  each_own(first, fields.size() / field_count, [&](std::size_t local, std::size_t global, std::size_t count) {
    executor_->read(local, fields.subspan((global - first) * field_count, count * field_count));
  });
  world_.join(fields);
}

void DistributedExecutor::derivative(std::span<const double> signals, std::span<double> rates) {
  std::vector<double> own(part_.problem.lattice.element_count * field_count);
  executor_->derivative(signals, own);
  std::fill(rates.begin(), rates.end(), 0.0);
  for (const Run& run : part_.runs)
    std::copy_n(&own[run.local * field_count], run.count * field_count, &rates[run.global * field_count]);
  world_.join(rates);
}

Outcome DistributedExecutor::advance(long steps, std::span<const double> signals) {
  if (faulty_halo_) faulty_halo_->start();
  const Traffic before = exchange_->traffic();
  const double before_s = halo_->total_s();
  const Outcome own = executor_->advance(steps, signals);
  traffic_.messages += exchange_->traffic().messages - before.messages;
  traffic_.bytes += exchange_->traffic().bytes - before.bytes;
  traffic_.wait_s += halo_->total_s() - before_s;
  constexpr double never = std::numeric_limits<double>::infinity();
  const double step = world_.least(own.is_finite ? never : double(own.step));
  if (step == never) return {true, steps, 0};
  const bool is_first = !own.is_finite && double(own.step) == step;
  return {false, long(step), std::size_t(world_.least(is_first ? double(global_of(own.element)) : never))};
}

std::string DistributedExecutor::schedule() const {
  return fmt::format("{} rank{}, {}, halo {}; {}", info_.ranks, info_.ranks == 1 ? "" : "s", info_.decomposition,
                     info_.halo, executor_->schedule());
}

} // namespace dss
