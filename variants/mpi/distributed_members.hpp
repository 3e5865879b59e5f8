#pragma once
/// Computes an ensemble on all ranks of a job. Each rank computes whole members with the executor
/// of another variant, so ranks exchange nothing during steps.
#include "variants/api/api.hpp"
#include "variants/mpi/world.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace dss {

/// Where the elements of one rank lie among those of the ensemble.
struct MemberSlice {
  std::size_t members; ///< of the ensemble
  std::size_t width;   ///< members of each rank
  std::size_t first;   ///< first member of this rank

  /// Number of own elements before an element of the ensemble.
  std::size_t own_before(std::size_t element) const {
    const std::size_t member = std::clamp(element % members, first, first + width);
    return element / members * width + (member - first);
  }
  /// The element of the ensemble that an own element is.
  std::size_t place_of(std::size_t own) const {
    return own / width * members + first + own % width;
  }
};

/// Rank r computes the members [r w, (r + 1) w), where w is the number of lanes of its variant. All
/// calls are collective, except write, restore, rank_info, traffic, outcomes, workers, bytes,
/// schedule and work_alone.
class DistributedMembers final : public Executor,
                                 public StateTransfer,
                                 public RankGroup,
                                 public MemberOutcomes {
public:
  explicit DistributedMembers(const Setup& setup);
  void write(std::size_t first, std::span<const double> fields) override;
  void read(std::size_t first, std::span<double> fields) override;
  void derivative(std::span<const double> signals, std::span<double> rates) override;
  Outcome advance(long steps, std::span<const double> signals) override;
  std::string schedule() const override;
  int workers() const override { return workers_; }
  std::size_t bytes() const override { return bytes_; }
  StateTransfer* state_transfer() override { return this; }
  int kept_fields() const override { return kept_fields_; }
  void save(std::size_t first, std::span<double> kept) override;
  void restore(std::size_t first, std::span<const double> kept) override;
  RankGroup* rank_group() override { return this; }
  RankInfo rank_info() const override { return info_; }
  Traffic traffic() const override { return {}; }
  void work_alone(bool is_alone) override { world_.work_alone(is_alone); }
  std::vector<double> gather(double value) override { return world_.gather(value); }
  MemberOutcomes* member_outcomes() override { return this; }
  std::span<const Outcome> outcomes() const override { return outcomes_; }

private:
  /// Makes the executor of this rank's members.
  void make_own(const Setup& setup);
  std::vector<double> own_signals(std::span<const double> signals) const;
  /// Elements of the whole from `first` on, each of so many numbers.
  struct Elements {
    std::size_t first, numbers;
  };
  /// The own elements among them: the index of the first, and their numbers.
  std::pair<std::size_t, std::vector<double>> own_of(const Elements& elements,
                                                     std::span<const double> whole) const;
  /// Puts numbers of the own elements, from `first_own` on, into those of the whole, and joins all
  /// ranks'.
  void join(const Elements& elements, std::size_t first_own, std::span<const double> own,
            std::span<double> whole);
  bool is_own_alive() const;
  Outcome advance_own(long steps, const std::vector<double>& signals);
  /// Tells all ranks how the own members ended.
  void join_outcomes();

  World& world_;
  const MemberSlice slice_;
  bool is_idle_ = false;      ///< all own members only fill lanes
  std::size_t own_count_ = 0; ///< elements
  RankInfo info_;
  std::optional<Ensemble> ensemble_; ///< of this rank, if it has lanes
  std::unique_ptr<Executor> executor_;
  std::vector<Outcome> outcomes_; ///< of all members
  int workers_ = 0, kept_fields_ = 0;
  std::size_t bytes_ = 0;
};

/// Members that all ranks compute at once (Plugin::ensemble_lanes). 1 if the user asked how to
/// divide a body, by a decomposition, a halo strategy or measured shares, or if ranks have packs of
/// different width. Collective in a job.
int members_of_ranks(Precision precision, const Distribution& distribution);

} // namespace dss
