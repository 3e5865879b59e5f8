/// The automatic choice: times each executor alone for a short while, predicts what members would
/// reach together, and tries what promises to be faster.
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/cost/halo_cost.hpp"
#include "variants/hybrid/balance.hpp"
#include "variants/hybrid/choice.hpp"
#include "variants/hybrid/clock.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double timing_s = 8e-3;
constexpr int timings = 4;
constexpr std::size_t small_elements = 20'000, large_elements = 1'000'000;

/// One or several members that could compute the scene.
struct Candidate {
  std::vector<Participant> participants;
  double step_s = never; ///< least of the timings [s]
  /// Kept for more timings and for the run, unless the scene is large.
  std::unique_ptr<Executor> executor;
  double launch_s = 0;    ///< of its device [s]
  std::string unusable{}; ///< empty, or why it cannot compute this scene
  long steps = 1;         ///< steps of a timing
};

std::string text_of(const std::vector<Participant>& participants) {
  std::string text;
  for (const Participant& one : participants)
    text += fmt::format("{}{}", text.empty() ? "" : "+", name(one.member));
  return text;
}

class Trials {
public:
  explicit Trials(const Setup& setup)
      : setup_(setup), is_large_(setup.problem.lattice.element_count > large_elements) {}

  /// Times all candidates in turn, several times. Candidates with devices that cannot compute the
  /// scene (no double precision, too little memory) keep a step of `never`.
  void time(std::vector<Candidate>& candidates) {
    for (int n = 0; n < (is_large_ ? 1 : timings); ++n)
      for (Candidate& one : candidates) {
        try {
          if (one.unusable.empty()) time(one);
        } catch (const InputError& error) {
          if (one.participants.back().member.device.empty()) throw;
          one.unusable = error.what();
          one.step_s = never;
        }
      }
  }
  /// Makes the state that of a new executor.
  void reset(Executor& executor) const {
    const std::size_t elements = setup_.problem.lattice.element_count;
    const std::vector<double> zeros(std::min(elements, large_elements) * field_count);
    for (std::size_t first = 0; first < elements; first += large_elements)
      executor.write(
          first, std::span(zeros).first(std::min(large_elements, elements - first) * field_count));
  }

private:
  double run_s(const Candidate& one) const {
    const std::vector<double> signals =
        signal_rows(setup_.problem, setup_.method, setup_.dt, 0, one.steps);
    const double began_s = now_s();
    one.executor->advance(one.steps, signals);
    return now_s() - began_s;
  }
  void time(Candidate& one) const {
    if (one.executor == nullptr) {
      one.executor = make_executor(setup_, one.participants);
      one.launch_s = device_use(*one.executor).launch_s;
      run_s(one); // devices compile at their first launch
      while (run_s(one) < timing_s && one.steps < 1 << 16) one.steps *= 2;
    }
    // Twice, because OpenMP's threads of the previous executor spin for some more milliseconds.
    for (int n = 0; n < 2; ++n) one.step_s = std::min(one.step_s, run_s(one) / double(one.steps));
    if (is_large_) one.executor.reset();
  }

  const Setup& setup_;
  const bool is_large_;
};

/// Executors that could compute the scene alone: the fastest CPU variant, every device, and in
/// small scenes the CPU variant on one thread, since there more threads may cost more than they
/// gain.
std::vector<Candidate> single_candidates(const Setup& setup,
                                         const std::vector<Participant>& devices) {
  const Plugin& cpu = load_variant("auto");
  std::vector<Candidate> candidates;
  const auto add = [&](const Participant& one) { candidates.emplace_back().participants = {one}; };
  add({{cpu.name, "", setup.threads}, &cpu});
  if (setup.threads > 1 && setup.problem.lattice.element_count < small_elements)
    add({{cpu.name, "", 1}, &cpu});
  for (const Participant& device : devices) add(device);
  return candidates;
}

/// The link between members in this process: shared memory, and the device's launches.
Network link_of(const Candidate& device) {
  /// Time to wake a waiting thread; rate of the copies out and in.
  constexpr double nap_s = 5e-6, bytes_a_second = 8e9;
  return {2 * (nap_s + 2 * device.launch_s), 1 / bytes_a_second, 0, 0};
}

/// Predicted step of members whose speeds [element-steps/s] are known [s].
double predicted_s(const Setup& setup, const std::vector<double>& speed, const Network& link) {
  const HaloStrategy& strategy = *find_halo_strategy("shared");
  const StepSweeps sweeps(setup.method, setup.problem);
  const int parts = int(speed.size());
  const Decomposition decomposition = decompose(setup.problem, "strips", parts, {speed, {}});
  PlannedStrategy planned{std::string(strategy.name), 1, {}};
  for (int p = 0; p < parts; ++p) {
    const PartSize size = part_size(setup.problem, decomposition, p, sweeps.count());
    const double stage_speed = speed[std::size_t(p)] * sweeps.stages;
    planned.parts.push_back(
        plan_part(size,
                  part_times(size, strategy, sweeps, setup.problem.lattice.row_reach(),
                             {"", stage_speed, stage_speed}),
                  setup.precision));
  }
  return predicted_step_s(planned, link);
}

/// The CPU joined with each device, with all CPU threads or with one less; step_s is predicted.
std::vector<Candidate> joint_candidates(const Setup& setup, const std::vector<Candidate>& singles) {
  std::vector<Candidate> joint;
  if (setup.problem.lattice.rows.size() < 2) return joint;
  const double elements = double(setup.problem.lattice.element_count);
  for (const Candidate& single : singles) {
    Participant device = single.participants.front(), cpu = singles.front().participants.front();
    if (device.member.device.empty() || !single.unusable.empty()) continue;
    const double device_speed = elements / single.step_s / device.member.threads;
    device.member.threads = 1;
    for (const int threads : {setup.threads - 1, setup.threads}) {
      if (threads < 1 || (device.is_processor && threads == setup.threads)) continue;
      cpu.member.threads = threads;
      const double cpu_speed = elements / singles.front().step_s * threads / setup.threads;
      joint.emplace_back().participants = {cpu, device};
      joint.back().step_s = predicted_s(setup, {cpu_speed, device_speed}, link_of(single));
    }
  }
  return joint;
}

std::string times_of(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const Candidate& one : candidates) {
    text += fmt::format("{}{} ", text.empty() ? "" : ", ", text_of(one.participants));
    text += one.unusable.empty() ? fmt::format("{:.4g} us", 1e6 * one.step_s)
                                 : fmt::format("({})", one.unusable);
  }
  return text.empty() ? "none" : text;
}

Candidate& fastest(std::vector<Candidate>& candidates) {
  return *std::ranges::min_element(candidates, {}, &Candidate::step_s);
}

} // namespace

Choice choose_fastest(const Setup& setup, const std::vector<Participant>& devices) {
  std::vector<Candidate> singles = single_candidates(setup, devices);
  Choice choice;
  if (singles.size() == 1) {
    choice.participants = singles.front().participants;
    choice.reason = "no device can be used: the CPU alone";
    return choice;
  }
  Trials trials(setup);
  trials.time(singles);
  Candidate* best = &fastest(singles);
  std::vector<Candidate> joint = joint_candidates(setup, singles);
  choice.reason = fmt::format("alone, measured step: {}; joined, predicted: {}", times_of(singles),
                              times_of(joint));
  const double worthwhile_s = (1 - margin) * best->step_s;
  std::erase_if(joint, [&](const Candidate& one) { return one.step_s > worthwhile_s; });
  if (joint.empty()) {
    choice.reason += fmt::format("; joining does not pay: {} alone", text_of(best->participants));
  } else {
    for (Candidate& one : joint) one.step_s = never;
    trials.time(joint);
    trials.time(singles);
    best = &fastest(singles);
    choice.reason += fmt::format("; tried: {}, {} {:.4g} us", times_of(joint),
                                 text_of(best->participants), 1e6 * best->step_s);
    if (Candidate& other = fastest(joint); other.step_s < (1 - margin) * best->step_s)
      best = &other;
  }
  if (best->executor) trials.reset(*best->executor);
  choice.participants = best->participants;
  choice.speed = double(setup.problem.lattice.element_count) / best->step_s;
  choice.executor = std::move(best->executor);
  return choice;
}

} // namespace dss
