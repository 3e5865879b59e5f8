#include "variants/hybrid/joint.hpp"

#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/hybrid/clock.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace dss {
namespace {

/// The weights of the first shares.
std::vector<double> first_weights(const std::vector<Participant>& participants) {
  std::vector<double> weights;
  for (const Participant& one : participants) weights.push_back(one.member.weight);
  return std::ranges::count(weights, 0.0) > 0 ? std::vector<double>{} : weights;
}

/// Equal members need no calibration. In small scenes it would take longer than it saves.
bool is_worth_calibrating(const Problem& problem, const std::vector<Participant>& participants) {
  constexpr std::size_t least_elements = 5'000;
  const auto first = name(participants.front().member);
  return problem.lattice.element_count >= least_elements &&
         std::ranges::any_of(participants,
                             [&](const Participant& one) { return name(one.member) != first; });
}

} // namespace

JointExecutor::JointExecutor(const Setup& setup, std::vector<Participant> participants,
                             StepTime step_time)
    : setup_(setup), participants_(std::move(participants)), step_time_(std::move(step_time)),
      team_(participants_.size()) {
  const std::vector<double> weights = first_weights(participants_);
  build(decompose(setup_.problem, "strips", int(participants_.size()), {weights, {}}));
  if (weights.empty() && is_worth_calibrating(setup_.problem, participants_)) calibrate();
}

JointExecutor::~JointExecutor() {
  team_.run([&](std::size_t m) { parts_[m].reset(); });
}

void JointExecutor::each_member(const Act& act) {
  if (is_broken_) throw std::logic_error("hybrid: a member has failed before; make a new executor");
  try {
    team_.run([&](std::size_t m) {
      try {
        act(*parts_[m], m);
      } catch (...) {
        exchange_->stop();
        throw;
      }
    });
  } catch (...) {
    is_broken_ = true;
    throw;
  }
}

void JointExecutor::build(Decomposition decomposition) {
  const double began_s = now_s();
  past_use_ = device_use();
  decomposition_ = std::move(decomposition);
  elements_ = part_elements(decomposition_, setup_.problem.lattice);
  parts_.resize(participants_.size());
  int threads = 0;
  for (const Participant& one : participants_) threads += one.member.threads;
  const bool is_crowded = unsigned(threads) > std::thread::hardware_concurrency();
  team_.run([&](std::size_t m) { parts_[m].reset(); });
  exchange_ = std::make_unique<Exchange>(is_crowded);
  const bool was_broken = std::exchange(is_broken_, true); // until all members are ready
  team_.run([&](std::size_t m) {
    parts_[m] =
        std::make_unique<MemberPart>(setup_, participants_[m], decomposition_, int(m), *exchange_);
  });
  is_broken_ = was_broken;
  std::vector<int> lanes;
  for (const auto& part : parts_) lanes.push_back(dss::halo_lanes(part->executor()));
  const bool is_mixed = are_mixed(lanes);
  const std::size_t bytes = number_bytes(setup_.precision);
  each_member([&](MemberPart& member, std::size_t) {
    member.halo().open(member.executor(), is_mixed, bytes);
  });
  each_member(
      [&](MemberPart& member, std::size_t) { member.halo().connect(member.executor(), bytes); });
  build_s_ = now_s() - began_s;
}

void JointExecutor::write(std::size_t first, std::span<const double> fields) {
  each_member([&](MemberPart& member, std::size_t) {
    // A write stops leapfrog in all members, even in those that own none of these elements.
    member.executor().write(0, {});
    member.each_own(first, fields.size() / field_count,
                    [&](std::size_t local, std::size_t global, std::size_t count) {
                      member.executor().write(local, fields.subspan((global - first) * field_count,
                                                                    count * field_count));
                    });
  });
}

void JointExecutor::read(std::size_t first, std::span<double> fields) {
  each_member([&](MemberPart& member, std::size_t) {
    member.executor().read(0, {}); // leapfrog: all members must take part
    member.each_own(first, fields.size() / field_count,
                    [&](std::size_t local, std::size_t global, std::size_t count) {
                      member.executor().read(local, fields.subspan((global - first) * field_count,
                                                                   count * field_count));
                    });
  });
}

void JointExecutor::derivative(std::span<const double> signals, std::span<double> rates) {
  each_member([&](MemberPart& member, std::size_t) {
    std::vector<double> own(member.part().problem.lattice.element_count * field_count);
    member.executor().derivative(signals, own);
    for (const Run& run : member.part().runs)
      std::copy_n(&own[run.local * field_count], run.count * field_count,
                  &rates[run.global * field_count]);
  });
}

int JointExecutor::kept_fields() const {
  const int count = dss::kept_fields(parts_.front()->executor());
  const bool is_common = std::ranges::all_of(
      parts_, [&](const auto& part) { return dss::kept_fields(part->executor()) == count; });
  return is_common ? count : 0;
}

void JointExecutor::save(std::size_t first, std::span<double> kept) {
  const std::size_t width = std::size_t(kept_fields());
  each_member([&](MemberPart& member, std::size_t) {
    member.each_own(first, kept.size() / width,
                    [&](std::size_t local, std::size_t global, std::size_t count) {
                      dss::save(member.executor(), local,
                                kept.subspan((global - first) * width, count * width));
                    });
  });
}

void JointExecutor::restore(std::size_t first, std::span<const double> kept) {
  const std::size_t width = std::size_t(kept_fields());
  each_member([&](MemberPart& member, std::size_t) {
    member.each_own(first, kept.size() / width,
                    [&](std::size_t local, std::size_t global, std::size_t count) {
                      dss::restore(member.executor(), local,
                                   kept.subspan((global - first) * width, count * width));
                    });
  });
}

int JointExecutor::workers() const {
  return std::accumulate(parts_.begin(), parts_.end(), 0, [](int sum, const auto& part) {
    return sum + part->executor().workers();
  });
}

std::size_t JointExecutor::bytes() const {
  return std::accumulate(
      parts_.begin(), parts_.end(), std::size_t(0),
      [](std::size_t sum, const auto& part) { return sum + part->executor().bytes(); });
}

std::string JointExecutor::schedule() const {
  std::string text;
  for (std::size_t m = 0; m < parts_.size(); ++m)
    text +=
        fmt::format("{}{} {:.3g} %", m == 0 ? "" : ", ", name(participants_[m].member),
                    100.0 * double(elements_[m]) / double(setup_.problem.lattice.element_count));
  return fmt::format("{} members, deep halos: {}; {}", parts_.size(), text,
                     parts_.front()->executor().schedule());
}

DeviceUse JointExecutor::device_use() const {
  DeviceUse all = past_use_;
  for (const auto& part : parts_)
    if (part != nullptr) all += dss::device_use(part->executor());
  return all;
}

HybridInfo JointExecutor::hybrid_info() const {
  HybridInfo info;
  for (std::size_t m = 0; m < parts_.size(); ++m) {
    const double step_s = step_s_.empty() ? 0 : step_s_[m];
    info.members.push_back(
        {name(participants_[m].member), step_s > 0 ? double(elements_[m]) / step_s : 0,
         double(elements_[m]) / double(setup_.problem.lattice.element_count), step_s});
  }
  info.rebalances = rebalances_;
  return info;
}

} // namespace dss
