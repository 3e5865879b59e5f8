#pragma once
/// The steps of an ensemble: passes of all batches over time, on threads.
#include "experiments/base/usage.hpp"
#include "experiments/run/ensemble/ensemble_checkpoint.hpp"
#include "experiments/run/ensemble/ensemble_plan.hpp"
#include "experiments/run/ensemble/ensemble_record.hpp"
#include "experiments/run/ensemble/member_batch.hpp"
#include "experiments/run/ensemble/member_run.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string_view>
#include <tuple>
#include <vector>

namespace dss {

/// All batches of an ensemble and what they are timed with.
class EnsembleRun {
public:
  explicit EnsembleRun(const RunRequest& request);
  void run();
  EnsembleResult result() const;

private:
  void make_batches();
  void describe_executors();
  void warm_up();
  enum class Looks { none, at_stops, at_steps };
  void begin(std::size_t b, Looks looks);
  /// Runs a batch from where it stands to a step, or to its end. @return the time in advance() [s]
  double go_on(std::size_t b, Looks looks, long until);
  double run_to(MemberBatch& batch, long stop);
  void look(std::size_t b, Looks looks);
  void tell_failures(std::size_t b);
  std::vector<long> stops(std::size_t b, Looks looks) const;
  /// Runs all batches from the start to the end. @return the time of the busiest thread [s]
  double pass(Looks looks);
  /// The same, from the start or from a checkpoint, and saved at pauses that all batches share.
  double saved_pass();
  /// @return the step from which the ensemble goes on
  long resume(const RunIdentity& identity);
  long last_step() const;
  /// Does `work(batch)` for all batches. @return the time of the busiest thread [s]
  double on_team(const std::function<double(std::size_t)>& work);
  /// Work of one thread is metered as it is timed; of several threads with all that they do.
  Usage metered(const std::function<void()>& work);
  /// What this rank exchanged for all batches so far.
  Traffic sent() const;
  void take_samples(double first_s);
  std::uint64_t digest_of_all();
  bool is_balanced_by_steps() const;
  bool are_all_ok() const {
    return std::ranges::all_of(members_, [](const auto& member) { return member->is_ok(); });
  }
  template <class Visit>
  void each_member(Visit&& visit);
  /// Steps of all batches together, from the start on.
  double steps_of_batches() const;

  const RunRequest& request_;
  EnsemblePlan plan_; ///< make_batches() puts halo strategies into its distributions
  std::vector<std::unique_ptr<MemberRun>> members_;
  std::vector<std::unique_ptr<MemberBatch>> batches_;
  std::vector<MemberBatch*> batch_of_; ///< each member
  int team_ = 1;                       ///< threads that take batches
  Usage usage_;                        ///< of the timed steps of a team of one
  double steps_before_ = 0;            ///< of steps_of_batches(), before a restart
  /// What a trial found for the first member that ranks divide. Others like it take the same
  /// strategy: all members have one topology.
  using TriedFor = std::tuple<Model, std::string_view, int>; ///< also the method and its stages
  static TriedFor tried_for(const RunPlan& plan);
  std::map<TriedFor, RankInfo> tried_halos_;
  RunResult whole_;
};

} // namespace dss
