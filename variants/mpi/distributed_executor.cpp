#include "variants/mpi/distributed_executor.hpp"

#include "variants/mpi/rank_variant.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace dss {

DistributedExecutor::DistributedExecutor(const Setup& asked)
    : world_(World::instance()), fault_(Fault::of_rank(world_.rank())) {
  Setup setup = asked;
  setup.distribution = &distribution_of(asked);
  const Plugin& plugin = rank_plugin(setup, world_);
  info_ = info_of_ranks(plugin, world_);
  const Spread found = spread(setup, plugin, world_, fault_);
  part_.emplace(setup, plugin, found.decomposition, *found.halo, world_, fault_);
  info_.decomposition = found.decomposition.method;
  info_.halo = found.halo->name;
  info_.halo_reason = found.halo_reason;
  info_.network = found.network;
  info_.imbalance = world_.largest(double(part_->part().own_elements)) * world_.ranks() /
                    double(setup.problem.lattice.element_count);
  for (const double workers : world_.gather(part_->executor().workers())) workers_ += int(workers);
  for (const double bytes : world_.gather(double(part_->executor().bytes())))
    bytes_ += std::size_t(bytes);
  const int kept = dss::kept_fields(part_->executor());
  kept_fields_ = world_.least(kept) == world_.largest(kept) ? kept : 0;
}

template <class Visit>
void DistributedExecutor::each_own(std::size_t first, std::size_t count, Visit&& visit) const {
  for (const Run& run : part_->part().runs) {
    const std::size_t begin = std::max(first, run.global),
                      end = std::min(first + count, run.global + run.count);
    if (begin < end) visit(run.local + (begin - run.global), begin, end - begin);
  }
}

std::size_t DistributedExecutor::global_of(std::size_t local) const {
  const auto after = std::upper_bound(part_->part().runs.begin(), part_->part().runs.end(), local,
                                      [](std::size_t l, const Run& run) { return l < run.local; });
  const Run& run = *(after - 1);
  return run.global + (local - run.local);
}

void DistributedExecutor::write(std::size_t first, std::span<const double> fields) {
  // A write stops leapfrog on all ranks, even on those that own none of these elements.
  part_->executor().write(0, {});
  each_own(first, fields.size() / field_count,
           [&](std::size_t local, std::size_t global, std::size_t count) {
             part_->executor().write(
                 local, fields.subspan((global - first) * field_count, count * field_count));
           });
}

void DistributedExecutor::read(std::size_t first, std::span<double> fields) {
  part_->executor().read(0, {}); // collective, since leapfrog needs halos for it
  std::fill(fields.begin(), fields.end(), 0.0);
  each_own(first, fields.size() / field_count,
           [&](std::size_t local, std::size_t global, std::size_t count) {
             part_->executor().read(
                 local, fields.subspan((global - first) * field_count, count * field_count));
           });
  world_.join(fields);
}

void DistributedExecutor::save(std::size_t first, std::span<double> kept) {
  const auto width = std::size_t(kept_fields_);
  std::fill(kept.begin(), kept.end(), 0.0);
  each_own(
      first, kept.size() / width, [&](std::size_t local, std::size_t global, std::size_t count) {
        dss::save(part_->executor(), local, kept.subspan((global - first) * width, count * width));
      });
  world_.join(kept);
}

void DistributedExecutor::restore(std::size_t first, std::span<const double> kept) {
  const auto width = std::size_t(kept_fields_);
  each_own(first, kept.size() / width,
           [&](std::size_t local, std::size_t global, std::size_t count) {
             dss::restore(part_->executor(), local,
                          kept.subspan((global - first) * width, count * width));
           });
}

void DistributedExecutor::derivative(std::span<const double> signals, std::span<double> rates) {
  std::vector<double> own(part_->part().problem.lattice.element_count * field_count);
  part_->executor().derivative(signals, own);
  std::fill(rates.begin(), rates.end(), 0.0);
  for (const Run& run : part_->part().runs)
    std::copy_n(&own[run.local * field_count], run.count * field_count,
                &rates[run.global * field_count]);
  world_.join(rates);
}

Outcome DistributedExecutor::advance(long steps, std::span<const double> signals) {
  const Outcome own = part_->advance(steps, signals);
  constexpr double never = std::numeric_limits<double>::infinity();
  const double step = world_.least(own.is_finite ? never : double(own.step));
  if (step == never) return {true, steps, 0};
  const bool is_first = !own.is_finite && double(own.step) == step;
  return {false, long(step),
          std::size_t(world_.least(is_first ? double(global_of(own.element)) : never))};
}

StepMaxima DistributedExecutor::try_step(double dt, std::span<const double> signals) {
  StepMaxima maxima = part_->try_step(dt, signals);
  std::vector<double> values(maxima.error.begin(), maxima.error.end());
  values.insert(values.end(), maxima.state.begin(), maxima.state.end());
  values.push_back(maxima.is_finite ? 0 : 1);
  world_.largest(values);
  std::copy_n(values.begin(), StepMaxima::kinds, maxima.error.begin());
  std::copy_n(values.begin() + StepMaxima::kinds, StepMaxima::kinds, maxima.state.begin());
  maxima.is_finite = values.back() == 0;
  return maxima;
}

std::string DistributedExecutor::schedule() const {
  return fmt::format("{} rank{}, {}, halo {}; {}", info_.ranks, info_.ranks == 1 ? "" : "s",
                     info_.decomposition, info_.halo, part_->executor().schedule());
}

} // namespace dss
