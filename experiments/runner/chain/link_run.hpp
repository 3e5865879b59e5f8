#pragma once
/// A link of the chain as an executor, and the errors of whole runs.
#include "experiments/runner/chain/chain_study.hpp"
#include "experiments/runner/usage.hpp"
#include "solver/numerics/method.hpp"
#include "solver/scene/scene.hpp"
#include "variants/api.hpp"

#include <functional>
#include <map>
#include <memory>

namespace dss {

/// A link's executor, from the initial state on.
class LinkRun {
public:
  LinkRun(const ChainStudy& study, const Scene& scene, const ChainLink& link);
  double dt() const { return dt_; } ///< [s]
  /// From where it is, or from the start where the run would pass its end. @throws InputError if it goes non-finite
  void advance(long steps);
  double wall_s() const { return wall_s_; }     ///< of the last advance [s]
  const Usage& usage() const { return usage_; } ///< the same
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

/// Model, precision, method and steps: what an error depends on.
std::string numerics_of(const ChainLink& link);

/// Errors of whole runs against the solution, by numerics; each computed by the fastest variant.
class ChainErrors {
public:
  ChainErrors(const ChainStudy& study, const Scene& scene, std::function<void(const std::string&)> note);
  double of_solution() const { return solution_error_; }
  /// Largest difference of displacements at any saved time over the largest displacement at any.
  double of(const ChainLink& link);

private:
  const ChainStudy& study_;
  const Scene& scene_;
  std::function<void(const std::string&)> note_;
  const States solution_;
  double solution_error_ = 0;
  std::map<std::string, double> errors_;
};

} // namespace dss
