#include "variants/hybrid/member_part.hpp"

#include "solver/error.hpp"
#include "variants/api/step_sweeps.hpp"
#include "variants/hybrid/balance.hpp"
#include "variants/hybrid/clock.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

std::unique_ptr<Executor> make_executor(const Setup& whole, const Participant& participant,
                                        const PartSetup& part_setup) {
  const Member& member = participant.member;
  require_terms(*participant.plugin, whole.problem);
  auto executor = participant.plugin->create({part_setup.part.problem, whole.method, whole.model,
                                              whole.precision, whole.dt, member.threads,
                                              &part_setup, nullptr, member.device});
  if (halo_copies(*executor) == 0)
    throw InputError(fmt::format("hybrid: {}: {} does not compute parts; give one that does",
                                 name(member), participant.plugin->name));
  return executor;
}

} // namespace

MemberPart::MemberPart(const Setup& whole, const Participant& participant,
                       const Decomposition& decomposition, int index, Exchange& exchange)
    : part_(make_part(whole.problem, decomposition, index,
                      StepSweeps(whole.method, whole.problem).count())),
      halo_(part_, exchange), part_setup_{part_, halo_, false, true},
      executor_(make_executor(whole, participant, part_setup_)) {}

Outcome MemberPart::advance(long steps, std::span<const double> signals) {
  const double began_s = now_s();
  halo_.start_steps();
  Outcome outcome = executor_->advance(steps, signals);
  halo_.end_steps();
  block_s_ += now_s() - began_s;
  block_steps_ += steps;
  if (!outcome.is_finite) outcome.element = global_of(outcome.element);
  return outcome;
}

StepMaxima MemberPart::try_step(double dt, std::span<const double> signals) {
  halo_.start_steps();
  const StepMaxima maxima = adaptive(*executor_).try_step(dt, signals);
  halo_.end_steps();
  return maxima;
}

double MemberPart::step_s() {
  const double steps = double(std::max(1L, block_steps_));
  if (part_.neighbours.empty()) return block_s_ / steps;
  const double computed_s = dss::computing_s(*executor_);
  return computed_s < 0 ? median(halo_.step_s()) : (computed_s - computed_s_) / steps;
}

void MemberPart::begin_block() {
  halo_.step_s().clear();
  computed_s_ = dss::computing_s(*executor_);
  block_s_ = 0;
  block_steps_ = 0;
}

std::size_t MemberPart::global_of(std::size_t local) const {
  const auto behind = std::ranges::upper_bound(part_.runs, local, {}, &Run::local);
  return (behind - 1)->global + (local - (behind - 1)->local);
}

} // namespace dss
