#pragma once
/// Several members compute one scene together, each in a thread of its own, and keep their shares in balance.
#include "variants/hybrid/balance.hpp"
#include "variants/hybrid/member_part.hpp"
#include "variants/hybrid/team.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace dss {

/// A step of a member's part, as a test would have it instead of as measured [s].
using StepTime = std::function<double(std::size_t member, std::size_t elements)>;

class JointExecutor final : public Executor {
public:
  /// Shares are as the members' weights say; without weights they are calibrated by a few steps of all members at once.
  /// @param setup  of the whole scene  @param participants  two or more, at most as many as rows; weights: all or none
  /// @param step_time  null: as measured
  JointExecutor(const Setup& setup, std::vector<Participant> participants, StepTime step_time = {});
  ~JointExecutor() override;

  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  /// A member whose state fails goes on to the end of the block of steps; then the first failure of all counts. After an exception of
  /// a member no more can be computed.
  Outcome advance(long steps, std::span<const double> signals) override;
  /// With the shares as they are.
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
  /// In each member's thread. One that throws keeps no other waiting.
  void each_member(const Act& act);
  void build(Decomposition decomposition);
  void calibrate();
  /// A block of steps, or less. @return the first failure of all members
  Outcome run(long steps, std::span<const double> signals);
  /// What the members' steps have taken in this block.
  void take_times();
  void begin_block();
  /// Decomposes anew if that pays for steps_ahead steps more.
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
  std::vector<double> step_s_; ///< of each member, as measured last
  double build_s_ = 0;         ///< what the last decomposition took to set up
  long block_done_ = 0;        ///< steps of the block at hand
  double steps_done_ = 0;
  int rebalances_ = 0;
  bool is_broken_ = false;
  Team team_; ///< last: ends first
};

} // namespace dss
