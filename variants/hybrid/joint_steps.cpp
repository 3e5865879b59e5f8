/// The steps of members together, and the balance of their shares.
#include "solver/numerics/signal_rows.hpp"
#include "variants/hybrid/clock.hpp"
#include "variants/hybrid/joint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dss {

Outcome JointExecutor::advance(long steps, std::span<const double> signals) {
  const std::size_t width = signal_count(setup_.problem),
                    step_width = width * std::size_t(setup_.method.stages);
  for (long done = 0; done < steps;) {
    if (balance_.is_uneven()) rebalance(std::max(double(steps - done), steps_done_));
    const long at_once = std::min(steps - done, block_steps() - block_done_);
    const auto own =
        signals.subspan(std::size_t(done) * step_width, std::size_t(at_once) * step_width + width);
    if (const Outcome outcome = run(at_once, own); !outcome.is_finite)
      return {false, done + outcome.step, outcome.element};
    done += at_once;
    steps_done_ += double(at_once);
    block_done_ += at_once;
    take_times();
    if (block_done_ < block_steps()) continue;
    balance_.add(step_s_);
    begin_block();
  }
  return {true, std::max(steps, 0L), 0};
}

StepMaxima JointExecutor::try_step(double dt, std::span<const double> signals) {
  std::vector<StepMaxima> maxima(parts_.size());
  each_member([&](MemberPart& member, std::size_t m) { maxima[m] = member.try_step(dt, signals); });
  StepMaxima all;
  for (const StepMaxima& one : maxima) all.add(one);
  return all;
}

void JointExecutor::accept_step() {
  each_member([](MemberPart& member, std::size_t) { adaptive(member.executor()).accept_step(); });
}

Outcome JointExecutor::run(long steps, std::span<const double> signals) {
  std::vector<Outcome> outcomes(parts_.size());
  each_member(
      [&](MemberPart& member, std::size_t m) { outcomes[m] = member.advance(steps, signals); });
  Outcome first{true, steps, 0};
  for (const Outcome& one : outcomes)
    if (!one.is_finite && (first.is_finite ||
                           std::pair(one.step, one.element) < std::pair(first.step, first.element)))
      first = one;
  return first;
}

long JointExecutor::block_steps() const {
  if (step_s_.empty()) return Balance::least_steps;
  const double longest_s = std::max(*std::ranges::max_element(step_s_), 1e-9);
  return std::max(Balance::least_steps, long(std::ceil(balance_.block_s() / longest_s)));
}

void JointExecutor::take_times() {
  step_s_.clear();
  for (std::size_t m = 0; m < parts_.size(); ++m)
    step_s_.push_back(step_time_ ? step_time_(m, elements_[m]) : parts_[m]->step_s());
}

void JointExecutor::begin_block() {
  for (const auto& part : parts_) part->begin_block();
  block_done_ = 0;
}

void JointExecutor::rebalance(double steps_ahead) {
  const std::vector<double> step_s = balance_.step_s(), speed = speeds(elements_, step_s);
  if (kept_fields() == 0 ||
      !std::ranges::all_of(speed, [](double v) { return std::isfinite(v) && v > 0; }))
    return;
  Decomposition next = decompose(setup_.problem, "strips", decomposition_.parts, {speed, {}});
  const double now = *std::ranges::max_element(step_s);
  const double gain = now - slowest_step_s(part_elements(next, setup_.problem.lattice), speed);
  if (next.shares == decomposition_.shares || !Balance::pays(now, gain, steps_ahead, build_s_))
    return;
  move(std::move(next));
  balance_.moved();
  ++rebalances_;
}

void JointExecutor::move(Decomposition decomposition) {
  const double began_s = now_s();
  const std::size_t count = setup_.problem.lattice.element_count * std::size_t(kept_fields());
  const auto kept = std::make_unique_for_overwrite<double[]>(count);
  save(0, {kept.get(), count});
  build(std::move(decomposition));
  restore(0, {kept.get(), count});
  begin_block();
  build_s_ = now_s() - began_s;
}

/// Does steps of the scene at rest until the shares fit, with at most three decompositions. The
/// state is zero again afterwards.
void JointExecutor::calibrate() {
  constexpr int rounds = 3, most_steps = 1 << 14;
  constexpr long least_steps = 4;
  constexpr double least_s = 5e-3;
  for (int round = 0; round < rounds; ++round) {
    long steps = least_steps;
    for (double took_s = 0; took_s < least_s && steps <= most_steps; steps *= 2) {
      begin_block();
      const double began_s = now_s();
      run(steps, signal_rows(setup_.problem, setup_.method, setup_.dt, 0, steps));
      took_s = now_s() - began_s;
    }
    take_times();
    begin_block();
    const std::vector<double> speed = speeds(elements_, step_s_);
    const auto [least, most] = std::ranges::minmax_element(step_s_);
    if (*least >= (1 - Balance::tolerated) * *most || round + 1 == rounds) break;
    build(decompose(setup_.problem, "strips", decomposition_.parts, {speed, {}}));
  }
  each_member([](MemberPart& member, std::size_t) {
    const std::vector<double> zeros(member.part().problem.lattice.element_count * field_count);
    member.executor().write(0, zeros);
  });
}

} // namespace dss
