#pragma once
/// Runs a stage of the chain, and computes the errors of whole runs.
#include "experiments/base/usage.hpp"
#include "experiments/studies/chain/chain_study.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/scene.hpp"
#include "variants/api/api.hpp"

#include <functional>
#include <map>
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
  const Method& method_;
  double dt_, wall_s_ = 0;
  Usage usage_;
  long done_ = 0;
  std::unique_ptr<Executor> executor_;
  const long end_;
  const std::vector<double> start_;
};

using States = std::vector<std::vector<double>>; ///< fields at the saved times

/// Model, precision, method and steps: everything that the error depends on.
std::string numerics_of(const ChainStage& stage);

/// Errors of whole runs against the solution, by numerics_of. The fastest variant computes each
/// once.
class ChainErrors {
public:
  ChainErrors(const ChainStudy& study, const Scene& scene,
              std::function<void(const std::string&)> note);
  double of_solution() const { return solution_error_; }
  /// Largest difference of a displacement component at any saved time, relative to the largest
  /// component at any.
  double of(const ChainStage& stage);

private:
  const ChainStudy& study_;
  const Scene& scene_;
  std::function<void(const std::string&)> note_;
  const States solution_;
  double solution_error_ = 0;
  std::map<std::string, double> errors_;
};

} // namespace dss
