#pragma once
/// Runs a stage of the chain, and computes the errors of whole runs.
#include "experiments/base/usage.hpp"
#include "experiments/studies/chain/chain_study.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/scene.hpp"
#include "variants/api/api.hpp"

#include <functional>
#include <memory>

namespace dss {

/// An executor of a stage, starting from the initial state.
class StageRun {
public:
  StageRun(const ChainStudy& study, const Scene& scene, const ChainStage& stage);
  double dt() const { return dt_; } ///< [s]
  /// Advances by `steps` steps. Restarts from the initial state first if the run would pass its
  /// end.
  /// @throws InputError if the state becomes non-finite
  void advance(long steps);
  double wall_s() const { return wall_s_; }     ///< of the last advance [s]
  const Usage& usage() const { return usage_; } ///< of the last advance
  std::vector<double> state();

private:
  const Scene& scene_;
  const Method method_;
  double dt_, wall_s_ = 0;
  Usage usage_;
  long done_ = 0;
  std::unique_ptr<Executor> executor_;
  const long end_;
  const std::vector<double> start_;
};

using States = std::vector<std::vector<double>>; ///< fields at the saved times

/// Model, precision, method and steps.
std::string numerics_of(const ChainStage& stage);

/// Steps an interval of the longest stable step of a stage.
long stable_steps(const ChainStudy& study, const Problem& problem, const ChainStage& stage);

/// Error of a stage, and the last saved time [s] at which it was taken.
struct StageError {
  double largest = 0, until_s = 0;
};

/// Errors of runs against the solution, by the variant and the threads that are timed.
class ChainErrors {
public:
  ChainErrors(const ChainStudy& study, const Scene& scene,
              std::function<void(const std::string&)> note);
  double of_solution() const { return solution_error_; }
  /// Difference of the solution's run from the oracle in long double, after some of its steps.
  double of_oracle() const { return oracle_error_; }
  /// Largest difference of a displacement component at any saved time that the stage reaches in
  /// ChainStudy::error_s, relative to the largest component at any.
  StageError of(const ChainStage& stage) const;

private:
  const ChainStudy& study_;
  const Scene& scene_;
  std::function<void(const std::string&)> note_;
  const States solution_;
  double solution_error_ = 0, oracle_error_ = 0;
};

} // namespace dss
