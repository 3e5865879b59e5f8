#pragma once
/// The core of an execution target: what every executor can do.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace dss {

class StepTrials;
class PartHalos;
class StateTransfer;
class DeviceWork;
class RankGroup;
class HybridMembers;
class MemberOutcomes;
class MatrixFactors;
class EvaluationCount;

/// Result of advance(): either finite, or the step and element that failed first. A step fails when
/// the state is not finite, or when an implicit method could not solve the step's equations.
struct Outcome {
  bool is_finite = true;
  /// If finite: steps completed in this call. Else: the failing step, counted from 0.
  long step = 0;
  std::size_t element = 0;                           ///< the first element that is not finite
  std::string_view what = "the state is not finite"; ///< else why the step failed; static text
};

/// Computes one scene on one target (variants/api/capabilities.hpp has what some executors can do
/// besides). In a job of several ranks each rank makes one; all calls are collective unless they
/// say otherwise, and all ranks get the same results. Fields are those of kernels/fields.hpp in
/// double precision, whatever the model and the precision inside.
class Executor {
public:
  virtual ~Executor() = default;
  /// Sets the state of elements [first, first + fields.size() / 13) and restarts the method.
  /// @param fields  13 numbers an element, see kernels/fields.hpp
  virtual void write(std::size_t first, std::span<const double> fields) = 0;
  /// Gets the state of elements [first, first + fields.size() / 13).
  virtual void read(std::size_t first, std::span<double> fields) = 0;
  /// Time derivative of all fields at the present state.
  /// @param signals  one row, see solver/numerics/signal_rows.hpp
  /// @param rates    13 numbers for each element of the problem, in [unit of the field / s]
  virtual void derivative(std::span<const double> signals, std::span<double> rates) = 0;
  /// Advances by `steps` steps. Stops at the first step that fails.
  /// @param signals  steps * method.stages + 1 rows, see solver/numerics/signal_rows.hpp
  virtual Outcome advance(long steps, std::span<const double> signals) = 0;
  /// One line for the record, for example "wavefront, reach 1" or "stage by stage: extra links".
  virtual std::string schedule() const = 0;
  /// Threads that compute: those of Setup, or fewer if the problem has fewer rows.
  virtual int workers() const = 0;
  /// Memory for state, halos, rings and masks [bytes].
  virtual std::size_t bytes() const = 0;

  /// Optional capabilities (capabilities.hpp); null: this executor lacks it.
  virtual StepTrials* step_trials() { return nullptr; }
  virtual PartHalos* part_halos() { return nullptr; }
  virtual StateTransfer* state_transfer() { return nullptr; }
  virtual DeviceWork* device_work() { return nullptr; }
  virtual RankGroup* rank_group() { return nullptr; }
  virtual HybridMembers* hybrid_members() { return nullptr; }
  virtual MemberOutcomes* member_outcomes() { return nullptr; }
  virtual MatrixFactors* matrix_factors() { return nullptr; }
  virtual EvaluationCount* evaluation_count() { return nullptr; }
};

} // namespace dss
