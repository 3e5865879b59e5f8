#include "variants/hybrid/choice.hpp"

#include "solver/error.hpp"
#include "variants/hybrid/joint.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

Participant participant_of(const Member& member) {
  const Plugin& plugin = load_variant(member.variant);
  if (plugin.is_distributed || std::string_view(plugin.name) == "hybrid")
    throw InputError(fmt::format(
        "hybrid: member \"{}\": {} has parts of its own; give variants that compute one",
        name(member), plugin.name));
  if (const Plugin& fastest = load_variant("auto"); plugin.has_fma != fastest.has_fma)
    throw InputError(
        fmt::format("hybrid: member \"{}\": {} rounds otherwise than {} (one of them without fused "
                    "multiply-add), and the state would depend on shares",
                    name(member), plugin.name, fastest.name));
  Participant participant{member, &plugin};
  participant.member.variant = plugin.name;
  return participant;
}

/// Two members that really compute jointly, whether it pays or not. The second computes on a device
/// if there is one.
std::vector<Participant> default_participants(int threads, const std::string& device) {
  const int second = std::max(1, threads / 2), first = std::max(1, threads - second);
  std::vector<Participant> participants{participant_of({"auto", "", first})};
  const std::vector<Participant> devices =
      device == no_device ? std::vector<Participant>{} : device_participants(second);
  participants.push_back(devices.empty() ? participant_of({"auto", "", second}) : devices.front());
  return participants;
}

} // namespace

std::vector<Participant> device_participants(int threads) {
  const Plugin* plugin = nullptr;
  try {
    plugin = &load_variant("opencl");
  } catch (const InputError&) { // this build or machine has none
    return {};
  }
  if (plugin->devices == nullptr ||
      (plugin->why_unusable != nullptr && !plugin->why_unusable().empty()))
    return {};
  std::vector<Participant> participants;
  for (const DeviceEntry& device : plugin->devices())
    if (device.unusable.empty())
      participants.push_back({{plugin->name, device.id, device.kind == "cpu" ? threads : 1},
                              plugin,
                              device.kind == "cpu"});
  return participants;
}

std::unique_ptr<Executor> make_executor(const Setup& setup,
                                        const std::vector<Participant>& participants) {
  if (participants.size() > 1) return std::make_unique<JointExecutor>(setup, participants);
  const Member& member = participants.front().member;
  return participants.front().plugin->create({setup.problem, setup.method, setup.model,
                                              setup.precision, setup.dt, member.threads, nullptr,
                                              nullptr, member.device});
}

Choice choose(const Setup& setup) {
  if (setup.members == "auto") return choose_fastest(setup, device_participants(setup.threads));
  Choice choice;
  if (setup.members.empty())
    choice.participants = default_participants(setup.threads, setup.device);
  else
    for (const Member& member : parse_members(setup.members))
      choice.participants.push_back(participant_of(member));
  choice.participants.resize(
      std::min(choice.participants.size(), setup.problem.lattice.rows.size()));
  return choice;
}

} // namespace dss
