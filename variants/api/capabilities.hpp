#pragma once
/// What some executors can do besides the core. An executor has a capability if it derives from the
/// class and returns itself from Executor's function of that name. The free functions below ask an
/// executor and fall back on what holds without the capability.
#include "solver/numerics/step_control.hpp"
#include "variants/api/device.hpp"
#include "variants/api/distribution.hpp"
#include "variants/api/executor.hpp"
#include "variants/api/halo.hpp"
#include "variants/api/member.hpp"

#include <span>
#include <stdexcept>
#include <vector>

namespace dss {

/// Adaptive steps of a method with an error stage.
class StepTrials {
public:
  virtual ~StepTrials() = default;
  /// Tries a step of a method with an error stage. The present state remains.
  /// @param dt       length of the step [s]
  /// @param signals  method.stages rows, see stage_signals
  /// @return maxima over all elements; they are the same for any order of elements
  virtual StepMaxima try_step(double dt, std::span<const double> signals) = 0;
  /// Makes the result of the last tried step the state. That result must be finite.
  virtual void accept_step() = 0;
};

/// Computing a part of a problem, whose halo other executors compute.
class PartHalos {
public:
  virtual ~PartHalos() = default;
  /// Number of copies of the elements that the executor exchanges, for example one for each stage.
  virtual int halo_copies() const = 0;
  /// Lanes of a pack: elements that lie together in a copy. Two executors order a message alike if
  /// their lanes are equal. 0: the executor has an order of its own (see message_order.hpp).
  virtual int halo_lanes() const { return 0; }
  /// Where all stored numbers of some elements lie in one copy. Called before the first exchange.
  /// Own elements are read: each offset occurs once. Halo elements are written: an offset may occur
  /// at several places.
  /// @param elements  local numbers, ascending
  /// @param copy      0 to halo_copies() - 1
  virtual HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) = 0;
  /// Compute time in all calls of advance without overlapped halo exchange [s]; negative if
  /// unknown.
  virtual double computing_s() const { return -1; }
};

/// Moving elements from one executor to another in mid-run, to the last bit.
class StateTransfer {
public:
  virtual ~StateTransfer() = default;
  /// Numbers that the method keeps of an element: the 13 fields, and more with some methods
  /// (variants/api/kept_state.hpp). 0: save and restore are not available.
  virtual int kept_fields() const = 0;
  /// Gets everything that the method keeps of elements [first, first + kept.size() /
  /// kept_fields()). Another executor of the same method, model and precision can restore it and
  /// then computes the same bits, even if it has other elements.
  virtual void save(std::size_t first, std::span<double> kept) = 0;
  /// The reverse of save. The next call must be write or advance.
  virtual void restore(std::size_t first, std::span<const double> kept) = 0;
};

/// Computing on a device.
class DeviceWork {
public:
  virtual ~DeviceWork() = default;
  /// How a device was used, and what that cost.
  virtual DeviceUse device_use() const = 0;
  /// Repeats the last derivative() `times` times on the device without transfers, for timing of the
  /// kernel. Then reads the rates, unless `rates` is empty. Only `opencl` can.
  /// @return whether it did so
  virtual bool repeat_derivative(long times, std::span<double> rates) {
    return (void)times, (void)rates, false;
  }
};

/// Computing on all ranks of a job.
class RankGroup {
public:
  virtual ~RankGroup() = default;
  /// How the problem was distributed over ranks.
  virtual RankInfo rank_info() const = 0;
  /// What this rank exchanged in all calls of advance.
  virtual Traffic traffic() const = 0;
  /// true: this rank begins work during which the others may wait long. false: it has finished. Not
  /// collective.
  virtual void work_alone(bool is_alone) = 0;
  /// @return `value` of every rank, in the order of ranks. Collective.
  virtual std::vector<double> gather(double value) = 0;
};

/// Computing an ensemble. A member that fails ends alone.
class MemberOutcomes {
public:
  virtual ~MemberOutcomes() = default;
  /// Of each member: the outcome of the last advance that it took part in; elements are its own.
  /// advance() returns a failure when no member is left. write() brings all back.
  virtual std::span<const Outcome> outcomes() const = 0;
};

/// Computing by members of other variants.
class HybridMembers {
public:
  virtual ~HybridMembers() = default;
  /// The members of a hybrid, their speeds and shares.
  virtual HybridInfo hybrid_info() const = 0;
};

/// What the factors of a matrix took.
struct FactorInfo {
  long count = 0;    ///< factorisations
  double time_s = 0; ///< of all
  double bytes = 0;  ///< memory while the last one ran
};

/// Computing by the factors of a matrix.
class MatrixFactors {
public:
  virtual ~MatrixFactors() = default;
  /// Since the executor was made.
  virtual FactorInfo factor_info() const = 0;
};

/// Counting evaluations of the forces of all elements, where steps do not tell.
class EvaluationCount {
public:
  virtual ~EvaluationCount() = default;
  /// Since the executor was made.
  virtual double evaluations() const = 0;
};

/// @throws std::logic_error if the executor has no adaptive steps
inline StepTrials& adaptive(Executor& executor) {
  if (StepTrials* trials = executor.step_trials()) return *trials;
  throw std::logic_error("this executor has no adaptive steps");
}

/// 0: the executor cannot compute parts.
inline int halo_copies(Executor& executor) {
  const PartHalos* halos = executor.part_halos();
  return halos == nullptr ? 0 : halos->halo_copies();
}
inline int halo_lanes(Executor& executor) {
  const PartHalos* halos = executor.part_halos();
  return halos == nullptr ? 0 : halos->halo_lanes();
}
inline HaloLayout halo_layout(Executor& executor, std::span<const std::size_t> elements, int copy) {
  PartHalos* halos = executor.part_halos();
  return halos == nullptr ? HaloLayout{} : halos->halo_layout(elements, copy);
}
inline double computing_s(Executor& executor) {
  const PartHalos* halos = executor.part_halos();
  return halos == nullptr ? -1 : halos->computing_s();
}

/// 0: the state cannot be transferred.
inline int kept_fields(Executor& executor) {
  const StateTransfer* transfer = executor.state_transfer();
  return transfer == nullptr ? 0 : transfer->kept_fields();
}
inline void save(Executor& executor, std::size_t first, std::span<double> kept) {
  if (StateTransfer* transfer = executor.state_transfer()) transfer->save(first, kept);
}
inline void restore(Executor& executor, std::size_t first, std::span<const double> kept) {
  if (StateTransfer* transfer = executor.state_transfer()) transfer->restore(first, kept);
}

inline DeviceUse device_use(Executor& executor) {
  const DeviceWork* device = executor.device_work();
  return device == nullptr ? DeviceUse{} : device->device_use();
}
inline bool repeat_derivative(Executor& executor, long times, std::span<double> rates) {
  DeviceWork* device = executor.device_work();
  return device != nullptr && device->repeat_derivative(times, rates);
}

inline RankInfo rank_info(Executor& executor) {
  const RankGroup* ranks = executor.rank_group();
  return ranks == nullptr ? RankInfo{} : ranks->rank_info();
}
inline Traffic traffic(Executor& executor) {
  const RankGroup* ranks = executor.rank_group();
  return ranks == nullptr ? Traffic{} : ranks->traffic();
}
inline void work_alone(Executor& executor, bool is_alone) {
  if (RankGroup* ranks = executor.rank_group()) ranks->work_alone(is_alone);
}
inline std::vector<double> gather(Executor& executor, double value) {
  RankGroup* ranks = executor.rank_group();
  return ranks == nullptr ? std::vector<double>{value} : ranks->gather(value);
}

/// Nothing was factorised without the capability.
inline FactorInfo factor_info(Executor& executor) {
  const MatrixFactors* factors = executor.matrix_factors();
  return factors == nullptr ? FactorInfo{} : factors->factor_info();
}

/// Negative if steps tell.
inline double evaluations(Executor& executor) {
  const EvaluationCount* count = executor.evaluation_count();
  return count == nullptr ? -1 : count->evaluations();
}

inline HybridInfo hybrid_info(Executor& executor) {
  const HybridMembers* members = executor.hybrid_members();
  return members == nullptr ? HybridInfo{} : members->hybrid_info();
}

} // namespace dss
