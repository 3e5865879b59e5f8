#include "variants/mpi/distributed_members.hpp"

#include "variants/loading/loader.hpp"
#include "variants/mpi/rank_variant.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace dss {
namespace {

int lanes_of(const Plugin& plugin, Precision precision) {
  return plugin.ensemble_lanes == nullptr ? 1 : plugin.ensemble_lanes(precision, {});
}

/// A text that lives to the end of the program, as Outcome wants.
std::string_view kept_text(const std::string& text) {
  static std::set<std::string> texts;
  return *texts.insert(text).first;
}

MemberSlice slice_of(const Setup& setup, const World& world) {
  const std::size_t members = setup.ensemble->size(), width = members / std::size_t(world.ranks());
  return {members, width, std::size_t(world.rank()) * width};
}

/// Members of a slice. The first member of an ensemble comes again in lanes that have none.
std::size_t real_members(const Ensemble& all, const MemberSlice& slice) {
  std::size_t count = 0;
  for (std::size_t m = slice.first; m < slice.first + slice.width; ++m)
    count += m == 0 || all.members[m] != all.members.front();
  return count;
}

} // namespace

int members_of_ranks(Precision precision, const Distribution& distribution) {
  const Distribution default_one;
  if (distribution.decomposition != default_one.decomposition ||
      distribution.halo != default_one.halo || distribution.is_measured)
    return 1;
  const int lanes = lanes_of(load_variant(distribution.variant), precision);
  if (World::is_in_job()) {
    World& world = World::instance();
    const double least = world.least(lanes), largest = world.largest(lanes);
    if (least != largest) return 1;
  }
  return distribution.ranks * lanes;
}

DistributedMembers::DistributedMembers(const Setup& setup)
    : world_(World::instance()), slice_(slice_of(setup, world_)), outcomes_(slice_.members) {
  require_ranks(distribution_of(setup), world_);
  make_own(setup);
  info_.decomposition = "members";
  info_.halo = "none";
  const std::vector<double> members = world_.gather(double(real_members(*setup.ensemble, slice_)));
  is_idle_ = members[std::size_t(world_.rank())] == 0;
  info_.imbalance = std::ranges::max(members) * world_.ranks() /
                    std::accumulate(members.begin(), members.end(), 0.0);
  for (const double workers : world_.gather(executor_->workers())) workers_ += int(workers);
  for (const double bytes : world_.gather(double(executor_->bytes()))) bytes_ += std::size_t(bytes);
  const int kept = dss::kept_fields(*executor_);
  kept_fields_ = world_.least(kept) == world_.largest(kept) ? kept : 0;
}

void DistributedMembers::make_own(const Setup& setup) {
  Setup own = setup;
  const Plugin& plugin = rank_plugin(own, world_);
  info_ = info_of_ranks(plugin, world_);
  const Ensemble& all = *setup.ensemble;
  const Problem& first = *all.members[slice_.first];
  if (slice_.width > 1) {
    const auto own_of = [&](const auto& of_all) {
      const auto begin = of_all.begin() + std::ptrdiff_t(slice_.first);
      return std::vector(begin, begin + std::ptrdiff_t(slice_.width));
    };
    ensemble_ = interleave(own_of(all.members), own_of(all.dt));
  }
  own_count_ = first.lattice.element_count * slice_.width;
  executor_ = plugin.create({first,
                             setup.method,
                             setup.model,
                             setup.precision,
                             all.dt[slice_.first],
                             own.threads,
                             nullptr,
                             nullptr,
                             own.device,
                             {},
                             setup.rotation,
                             setup.tile,
                             ensemble_ ? &*ensemble_ : nullptr});
}

std::pair<std::size_t, std::vector<double>>
DistributedMembers::own_of(const Elements& elements, std::span<const double> whole) const {
  const auto [first, numbers] = elements;
  const std::size_t begin = slice_.own_before(first),
                    end = slice_.own_before(first + whole.size() / numbers);
  std::vector<double> own((end - begin) * numbers);
  for (std::size_t n = begin; n < end; ++n)
    std::copy_n(&whole[(slice_.place_of(n) - first) * numbers], numbers,
                &own[(n - begin) * numbers]);
  return {begin, std::move(own)};
}

void DistributedMembers::join(const Elements& elements, std::size_t first_own,
                              std::span<const double> own, std::span<double> whole) {
  const auto [first, numbers] = elements;
  std::ranges::fill(whole, 0.0);
  for (std::size_t n = 0; n < own.size() / numbers; ++n)
    std::copy_n(&own[n * numbers], numbers,
                &whole[(slice_.place_of(first_own + n) - first) * numbers]);
  world_.join(whole);
}

void DistributedMembers::write(std::size_t first, std::span<const double> fields) {
  const auto [begin, own] = own_of({first, field_count}, fields);
  executor_->write(begin, own);
  std::ranges::fill(outcomes_, Outcome{});
}

void DistributedMembers::read(std::size_t first, std::span<double> fields) {
  auto [begin, own] = own_of({first, field_count}, fields);
  executor_->read(begin, own);
  join({first, field_count}, begin, own, fields);
}

void DistributedMembers::save(std::size_t first, std::span<double> kept) {
  const Elements elements{first, std::size_t(kept_fields_)};
  auto [begin, own] = own_of(elements, kept);
  dss::save(*executor_, begin, own);
  join(elements, begin, own, kept);
}

void DistributedMembers::restore(std::size_t first, std::span<const double> kept) {
  const auto [begin, own] = own_of({first, std::size_t(kept_fields_)}, kept);
  dss::restore(*executor_, begin, own);
  std::ranges::fill(outcomes_, Outcome{});
}

void DistributedMembers::derivative(std::span<const double> signals, std::span<double> rates) {
  std::vector<double> own(own_count_ * field_count);
  executor_->derivative(own_signals(signals), own);
  join({0, field_count}, 0, own, rates);
}

std::vector<double> DistributedMembers::own_signals(std::span<const double> signals) const {
  std::vector<double> own;
  own.reserve(signals.size() / slice_.members * slice_.width);
  for (std::size_t n = slice_.first; n < signals.size(); n += slice_.members)
    own.insert(own.end(), signals.begin() + std::ptrdiff_t(n),
               signals.begin() + std::ptrdiff_t(n + slice_.width));
  return own;
}

bool DistributedMembers::is_own_alive() const {
  const auto own = std::span(outcomes_).subspan(slice_.first, slice_.width);
  return std::ranges::any_of(own, &Outcome::is_finite);
}

Outcome DistributedMembers::advance_own(long steps, const std::vector<double>& signals) {
  // Ranks meet only after many steps, and one whose members have failed waits all the time.
  world_.work_alone(true);
  const Outcome outcome = executor_->advance(steps, signals);
  world_.work_alone(false);
  return outcome;
}

Outcome DistributedMembers::advance(long steps, std::span<const double> signals) {
  if (!is_idle_ && is_own_alive()) {
    const Outcome outcome = advance_own(steps, own_signals(signals));
    MemberOutcomes* const of_members = executor_->member_outcomes();
    for (std::size_t m = 0; m < slice_.width; ++m)
      outcomes_[slice_.first + m] = of_members == nullptr ? outcome : of_members->outcomes()[m];
  }
  join_outcomes();
  const auto alive = std::ranges::find_if(outcomes_, &Outcome::is_finite);
  if (alive != outcomes_.end()) return {true, steps, 0};
  return *std::ranges::max_element(outcomes_, {}, &Outcome::step);
}

void DistributedMembers::join_outcomes() {
  constexpr std::size_t numbers = 3;
  std::vector<double> all(slice_.members * numbers);
  for (std::size_t m = slice_.first; m < slice_.first + slice_.width; ++m) {
    all[m * numbers] = outcomes_[m].is_finite;
    all[m * numbers + 1] = double(outcomes_[m].step);
    all[m * numbers + 2] = double(outcomes_[m].element);
  }
  world_.join(all);
  std::string why; // the ranks' members fail for one reason: that of their method
  const auto is_own = [&](std::size_t m) { return m / slice_.width == std::size_t(world_.rank()); };
  for (std::size_t m = 0; m < slice_.members; ++m) {
    if (is_own(m)) {
      if (!outcomes_[m].is_finite) why = outcomes_[m].what;
      continue;
    }
    outcomes_[m] = {all[m * numbers] != 0, long(all[m * numbers + 1]),
                    std::size_t(all[m * numbers + 2])};
  }
  if (std::ranges::all_of(outcomes_, &Outcome::is_finite)) return;
  const std::vector<std::string> reasons = world_.gather(why);
  for (std::size_t m = 0; m < slice_.members; ++m)
    if (!outcomes_[m].is_finite && !is_own(m))
      outcomes_[m].what = kept_text(reasons[m / slice_.width]);
}

std::string DistributedMembers::schedule() const {
  return fmt::format("{} rank{}, {} member{} each; {}", info_.ranks, info_.ranks == 1 ? "" : "s",
                     slice_.width, slice_.width == 1 ? "" : "s", executor_->schedule());
}

} // namespace dss
