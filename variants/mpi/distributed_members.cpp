#include "variants/mpi/distributed_members.hpp"

#include "solver/error.hpp"
#include "variants/loading/loader.hpp"
#include "variants/mpi/rank_variant.hpp"

#include <algorithm>
#include <fmt/format.h>
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

} // namespace

int members_of_ranks(Precision precision, const Distribution& distribution) {
  const Distribution default_one;
  if (distribution.decomposition != default_one.decomposition ||
      distribution.halo != default_one.halo || distribution.is_measured)
    return 1;
  return distribution.ranks * lanes_of(load_variant(distribution.variant), precision);
}

DistributedMembers::DistributedMembers(const Setup& asked)
    : world_(World::instance()), members_(asked.ensemble->size()),
      width_(members_ / std::size_t(world_.ranks())), outcomes_(members_) {
  static const Distribution alone;
  require_ranks(asked.distribution == nullptr ? alone : *asked.distribution, world_);
  make_own(asked);
  info_.decomposition = "members";
  info_.halo = "none";
  for (const double workers : world_.gather(executor_->workers())) workers_ += int(workers);
  for (const double bytes : world_.gather(double(executor_->bytes()))) bytes_ += std::size_t(bytes);
}

void DistributedMembers::make_own(const Setup& asked) {
  static const Distribution alone;
  Setup named = asked;
  if (named.distribution == nullptr) named.distribution = &alone;
  const Plugin& plugin = rank_plugin(named, world_);
  info_ = info_of_ranks(plugin, world_);
  const double lanes = lanes_of(plugin, asked.precision), width = double(width_);
  if (world_.least(lanes) != width || world_.largest(lanes) != width ||
      width_ * std::size_t(world_.ranks()) != members_)
    throw InputError(fmt::format("--ensemble: the variants {} of the ranks compute unequal numbers "
                                 "of members; name one by --variant",
                                 info_.variant));
  const Ensemble& all = *asked.ensemble;
  const Problem& first = *all.members[first_member()];
  Setup own{first,          asked.method, asked.model, asked.precision, all.dt[first_member()],
            asked.threads,  nullptr,      nullptr,     asked.device,    {},
            asked.rotation, asked.tile};
  if (width_ > 1) {
    const auto slice = [&](const auto& of_all) {
      const auto begin = of_all.begin() + std::ptrdiff_t(first_member());
      return std::vector(begin, begin + std::ptrdiff_t(width_));
    };
    ensemble_ = interleave(slice(all.members), slice(all.dt));
    own.ensemble = &*ensemble_;
  }
  own_count_ = first.lattice.element_count * width_;
  executor_ = plugin.create(own);
}

std::size_t DistributedMembers::own_before(std::size_t element) const {
  const std::size_t member = element % members_;
  const std::size_t passed = std::clamp(member, first_member(), first_member() + width_);
  return element / members_ * width_ + (passed - first_member());
}

void DistributedMembers::write(std::size_t first, std::span<const double> fields) {
  const std::size_t begin = own_before(first),
                    end = own_before(first + fields.size() / field_count);
  std::vector<double> own((end - begin) * field_count);
  for (std::size_t n = begin; n < end; ++n)
    std::copy_n(&fields[(place_of(n) - first) * field_count], field_count,
                &own[(n - begin) * field_count]);
  executor_->write(begin, own);
  std::ranges::fill(outcomes_, Outcome{});
}

void DistributedMembers::join(std::size_t first, std::size_t first_own, std::span<const double> own,
                              std::span<double> whole) {
  std::ranges::fill(whole, 0.0);
  for (std::size_t n = 0; n < own.size() / field_count; ++n)
    std::copy_n(&own[n * field_count], field_count,
                &whole[(place_of(first_own + n) - first) * field_count]);
  world_.join(whole);
}

void DistributedMembers::read(std::size_t first, std::span<double> fields) {
  const std::size_t begin = own_before(first),
                    end = own_before(first + fields.size() / field_count);
  std::vector<double> own((end - begin) * field_count);
  executor_->read(begin, own);
  join(first, begin, own, fields);
}

void DistributedMembers::derivative(std::span<const double> signals, std::span<double> rates) {
  std::vector<double> own(own_count_ * field_count);
  executor_->derivative(own_signals(signals), own);
  join(0, 0, own, rates);
}

std::vector<double> DistributedMembers::own_signals(std::span<const double> signals) const {
  std::vector<double> own;
  own.reserve(signals.size() / members_ * width_);
  for (std::size_t n = first_member(); n < signals.size(); n += members_)
    own.insert(own.end(), signals.begin() + std::ptrdiff_t(n),
               signals.begin() + std::ptrdiff_t(n + width_));
  return own;
}

bool DistributedMembers::is_own_alive() const {
  const auto own = std::span(outcomes_).subspan(first_member(), width_);
  return std::ranges::any_of(own, &Outcome::is_finite);
}

Outcome DistributedMembers::advance(long steps, std::span<const double> signals) {
  if (is_own_alive()) {
    const Outcome outcome = executor_->advance(steps, own_signals(signals));
    MemberOutcomes* const of_members = executor_->member_outcomes();
    for (std::size_t m = 0; m < width_; ++m)
      outcomes_[first_member() + m] = of_members == nullptr ? outcome : of_members->outcomes()[m];
  }
  join_outcomes();
  const auto alive = std::ranges::find_if(outcomes_, &Outcome::is_finite);
  if (alive != outcomes_.end()) return {true, steps, 0};
  return *std::ranges::max_element(outcomes_, {}, &Outcome::step);
}

void DistributedMembers::join_outcomes() {
  constexpr std::size_t numbers = 3;
  std::vector<double> all(members_ * numbers);
  for (std::size_t m = first_member(); m < first_member() + width_; ++m) {
    all[m * numbers] = outcomes_[m].is_finite;
    all[m * numbers + 1] = double(outcomes_[m].step);
    all[m * numbers + 2] = double(outcomes_[m].element);
  }
  world_.join(all);
  std::string why; // the ranks' members fail for one reason: that of their method
  const auto is_own = [&](std::size_t m) { return m / width_ == std::size_t(world_.rank()); };
  for (std::size_t m = 0; m < members_; ++m) {
    if (is_own(m)) {
      if (!outcomes_[m].is_finite) why = outcomes_[m].what;
      continue;
    }
    outcomes_[m] = {all[m * numbers] != 0, long(all[m * numbers + 1]),
                    std::size_t(all[m * numbers + 2])};
  }
  if (std::ranges::all_of(outcomes_, &Outcome::is_finite)) return;
  const std::vector<std::string> reasons = world_.gather(why);
  for (std::size_t m = 0; m < members_; ++m)
    if (!outcomes_[m].is_finite && !is_own(m)) outcomes_[m].what = kept_text(reasons[m / width_]);
}

std::string DistributedMembers::schedule() const {
  return fmt::format("{} rank{}, {} member{} each; {}", info_.ranks, info_.ranks == 1 ? "" : "s",
                     width_, width_ == 1 ? "" : "s", executor_->schedule());
}

} // namespace dss
