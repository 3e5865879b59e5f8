#pragma once
/// Chooses the members: those that the user asked for, a pair for tests of joint computing, or the
/// fastest.
#include "variants/hybrid/member_part.hpp"

#include <memory>
#include <string>
#include <vector>

namespace dss {

/// The chosen members. A single one computes the whole scene by itself.
struct Choice {
  std::vector<Participant> participants;
  std::string reason; ///< of an automatic choice: predicted and measured times of a step
  /// Of a single executor in the trials: its speed [element-steps/s], and the elements of the
  /// scene.
  double speed = 0, elements = 0;
  std::unique_ptr<Executor> executor; ///< set if trials have left one that is ready
};

/// The executor of one member on the whole scene, or of several members jointly.
std::unique_ptr<Executor> make_executor(const Setup& setup,
                                        const std::vector<Participant>& participants);

/// Chooses as Setup::members says. Empty: the fastest CPU variant with `opencl`, or with itself if
/// there is no device. Never more members than rows.
/// @throws InputError for members that do not exist or cannot compute here
Choice choose(const Setup& setup);

/// Setup::members "auto": the fastest single executor (a CPU variant or a device), unless a trial
/// shows that several members are faster by more than `margin`.
Choice choose_fastest(const Setup& setup, const std::vector<Participant>& devices);
inline constexpr double margin = 0.03;

/// The devices that `opencl` can use here.
/// @param threads  threads of a device that is the processor
std::vector<Participant> device_participants(int threads);

} // namespace dss
