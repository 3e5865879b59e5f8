#pragma once
/// Several members compute one scene together, each in a thread of its own. Elements move between
/// them to keep their shares in balance.
#include "variants/hybrid/balance.hpp"
#include "variants/hybrid/member_part.hpp"
#include "variants/hybrid/team.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace dss {

/// Time of a step of a member's part [s], given by a test in place of a measurement.
using StepTime = std::function<double(std::size_t member, std::size_t elements)>;

/// The executor of two or more members.
class JointExecutor final : public Executor,
                            public StepTrials,
                            public StateTransfer,
                            public DeviceWork,
                            public HybridMembers {
public:
  /// First shares are the members' weights. Without weights a few steps of all members together
  /// decide.
  /// @param setup         of the whole scene
  /// @param participants  two or more, at most as many as rows; all have weights or none
  /// @param step_time     null: times are measured
  JointExecutor(const Setup& setup, std::vector<Participant> participants, StepTime step_time = {});
  ~JointExecutor() override;

  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  /// A member whose state fails continues to the end of the block of steps; then the first failure
  /// of all members counts. After an exception of a member nothing more can be computed.
  Outcome advance(long steps, std::span<const double> signals) override;
  StepTrials* step_trials() override { return this; }
  StateTransfer* state_transfer() override { return this; }
  DeviceWork* device_work() override { return this; }
  HybridMembers* hybrid_members() override { return this; }
  /// Shares stay as they are.
  StepMaxima try_step(double dt, std::span<const double> signals) override;
  void accept_step() override;
  std::string schedule() const override;
  int workers() const override;
  std::size_t bytes() const override;
  int kept_fields() const override;
  void save(std::size_t first, std::span<double> kept) override;
  void restore(std::size_t first, std::span<const double> kept) override;
  DeviceUse device_use() const override;
  HybridInfo hybrid_info() const override;

private:
  using Act = std::function<void(MemberPart& member, std::size_t index)>;
  /// Calls `act` in each member's thread. If one throws, the others do not wait for it.
  void each_member(const Act& act);
  void build(Decomposition decomposition);
  void calibrate();
  /// Runs a block of steps, or fewer.
  /// @return the first failure of all members
  Outcome run(long steps, std::span<const double> signals);
  /// Takes the members' times of a step in this block.
  void take_times();
  void begin_block();
  /// Decomposes anew if that pays within the next steps_ahead steps.
  void rebalance(double steps_ahead);
  void move(Decomposition decomposition);
  long block_steps() const;

  const Setup setup_;
  const std::vector<Participant> participants_;
  const StepTime step_time_;
  Decomposition decomposition_;
  std::vector<std::size_t> elements_; ///< of each part
  std::unique_ptr<Exchange> exchange_;
  std::vector<std::unique_ptr<MemberPart>> parts_;
  DeviceUse past_use_; ///< by members before elements moved
  Balance balance_;
  std::vector<double> step_s_; ///< of each member, last measured [s]
  double build_s_ = 0;         ///< time to set up the last decomposition [s]
  long block_done_ = 0;        ///< steps of the present block
  double steps_done_ = 0;
  int rebalances_ = 0;
  bool is_broken_ = false;
  Team team_; ///< last member of the class, so that it ends first
};

} // namespace dss
