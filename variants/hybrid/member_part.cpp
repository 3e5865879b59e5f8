#include "variants/hybrid/member_part.hpp"

#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

std::unique_ptr<Executor> make_executor(const Setup& whole, const Participant& participant,
                                        const PartSetup& part_setup) {
  const Member& member = participant.member;
  auto executor = participant.plugin->create({part_setup.part.problem, whole.method, whole.model, whole.precision,
                                              whole.dt, member.threads, &part_setup, nullptr, member.device});
  if (executor->halo_copies() == 0)
    throw InputError(fmt::format("hybrid: {}: {} does not compute parts; give one that does", name(member),
                                 participant.plugin->name));
  return executor;
}

} // namespace

MemberPart::MemberPart(const Setup& whole, const Participant& participant, const Decomposition& decomposition,
                       int index, Exchange& exchange)
    : part_(make_part(whole.problem, decomposition, index, whole.method.stages)),
      halo_(part_, exchange), part_setup_{part_, halo_}, executor_(make_executor(whole, participant, part_setup_)) {}

std::size_t MemberPart::global_of(std::size_t local) const {
  const auto behind = std::ranges::upper_bound(part_.runs, local, {}, &Run::local);
  return (behind - 1)->global + (local - (behind - 1)->local);
}

} // namespace dss
