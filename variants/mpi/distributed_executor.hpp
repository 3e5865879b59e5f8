#pragma once
/// Computes one problem on all ranks of a job. Each rank computes its part with the executor of
/// another variant.
#include "variants/mpi/distributed_part.hpp"
#include "variants/mpi/spread.hpp"

#include <optional>

namespace dss {

/// All calls are collective, except rank_info, traffic, workers, bytes, schedule and work_alone.
class DistributedExecutor final : public Executor,
                                  public StepTrials,
                                  public StateTransfer,
                                  public RankGroup {
public:
  explicit DistributedExecutor(const Setup& setup);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  /// A rank whose state fails continues to the end of the call, because others wait for it. Then
  /// all ranks agree on the first failure.
  Outcome advance(long steps, std::span<const double> signals) override;
  StepTrials* step_trials() override { return this; }
  StateTransfer* state_transfer() override { return this; }
  RankGroup* rank_group() override { return this; }
  StepMaxima try_step(double dt, std::span<const double> signals) override;
  void accept_step() override { adaptive(part_->executor()).accept_step(); }
  /// 0 if a rank's variant has none.
  int kept_fields() const override { return kept_fields_; }
  void save(std::size_t first, std::span<double> kept) override;
  /// Every rank gets the same numbers, and takes those of its own elements.
  void restore(std::size_t first, std::span<const double> kept) override;
  std::string schedule() const override;
  int workers() const override { return workers_; }
  std::size_t bytes() const override { return bytes_; }
  RankInfo rank_info() const override { return info_; }
  Traffic traffic() const override { return part_->traffic(); }
  void work_alone(bool is_alone) override { world_.work_alone(is_alone); }
  std::vector<double> gather(double value) override { return world_.gather(value); }

private:
  /// Calls visit(local first, global first, count) for the own elements among [first, first +
  /// count).
  template <class Visit>
  void each_own(std::size_t first, std::size_t count, Visit&& visit) const;
  std::size_t global_of(std::size_t local) const;

  World& world_;
  const Fault fault_;
  RankInfo info_;
  std::optional<DistributedPart> part_;
  int workers_ = 0, kept_fields_ = 0;
  std::size_t bytes_ = 0;
};

} // namespace dss
