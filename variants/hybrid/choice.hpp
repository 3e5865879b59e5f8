#pragma once
/// Who computes: the members that were asked for, those for tests of joint computing, or those that are fastest.
#include "variants/hybrid/member_part.hpp"

#include <memory>
#include <string>
#include <vector>

namespace dss {

/// One member: it computes the whole scene by itself. Several: jointly.
struct Choice {
  std::vector<Participant> participants;
  std::string reason;                 ///< of an automatic choice: predicted and measured times of a step
  double speed = 0, elements = 0;     ///< of a single executor in the trials, element-steps a second; of the scene
  std::unique_ptr<Executor> executor; ///< ready, if trials have left one
};

/// The executor of one member on the whole scene, or of several.
std::unique_ptr<Executor> make_executor(const Setup& setup, const std::vector<Participant>& participants);

/// As Setup::members says; empty: the fastest CPU variant and `opencl`, or twice the CPU variant. Never more members than rows.
/// @throws InputError for members that do not exist or cannot compute here
Choice choose(const Setup& setup);

/// Setup::members "auto": a single executor, the fastest CPU variant or a device, unless a trial shows that several are faster by more than
/// `margin`.
Choice choose_fastest(const Setup& setup, const std::vector<Participant>& devices);
inline constexpr double margin = 0.03;

/// The devices that `opencl` can use here. @param threads  of those that are the processor
std::vector<Participant> device_participants(int threads);

} // namespace dss
