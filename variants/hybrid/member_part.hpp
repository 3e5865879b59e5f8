#pragma once
/// One member's part of the scene. It is made, used and destroyed in the member's own thread.
#include "variants/hybrid/exchange.hpp"

#include <memory>
#include <optional>

namespace dss {

/// A member, and what computes for it.
struct Participant {
  Member member;
  const Plugin* plugin = nullptr;
  bool is_processor = false; ///< its device is the processor that CPU variants use
};

/// The part of one member with its halo and its executor.
class MemberPart {
public:
  /// @param whole  setup of the whole scene
  /// @throws InputError if the variant computes no parts
  MemberPart(const Setup& whole, const Participant& participant, const Decomposition& decomposition,
             int index, Exchange& exchange);
  MemberPart(const MemberPart&) = delete;
  MemberPart& operator=(const MemberPart&) = delete;

  const Part& part() const { return part_; }
  MemberHalo& halo() { return halo_; }
  Executor& executor() { return *executor_; }
  const Executor& executor() const { return *executor_; }
  /// Calls visit(local first, global first, count) for the own elements among [first, first +
  /// count).
  template <class Visit>
  void each_own(std::size_t first, std::size_t count, Visit&& visit) const {
    for (const Run& run : part_.runs) {
      const std::size_t begin = std::max(first, run.global),
                        end = std::min(first + count, run.global + run.count);
      if (begin < end) visit(run.local + (begin - run.global), begin, end - begin);
    }
  }
  std::size_t global_of(std::size_t local) const;

  /// Executor::advance for a block of steps. The element of a failure has its global number.
  Outcome advance(long steps, std::span<const double> signals);
  StepMaxima try_step(double dt, std::span<const double> signals);
  /// The member's own time of a step since the block began [s]: from the executor if it knows, else
  /// the median between receives, or all of the time if there are no neighbours.
  double step_s();
  void begin_block();

private:
  const Part part_;
  MemberHalo halo_;
  const PartSetup part_setup_;
  const std::unique_ptr<Executor> executor_;
  double computed_s_ = 0; ///< before the block [s]
  double block_s_ = 0;    ///< time in advance [s]
  long block_steps_ = 0;
};

} // namespace dss
