#pragma once
/// Which sweeps over the rows a step has.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <string_view>

namespace dss {

/// A step has a sweep for each stage. If elements have a pressure it has two: the first one finds
/// the pressures at the input of the stage, the second one computes the stage. Both need the rows
/// beside their own, so each takes a layer of halo.
struct StepSweeps {
  int stages = 1;
  bool has_pressure = false;
  StepSweeps() = default;
  StepSweeps(int of_stages, bool with_pressure = false)
      : stages(of_stages), has_pressure(with_pressure) {}
  StepSweeps(const Method& method, const Problem& problem)
      : stages(method.stages), has_pressure(problem.has_pressure()) {}

  /// For the text of a schedule.
  std::string_view text() const { return has_pressure ? ", two sweeps a stage" : ""; }
  int a_stage() const { return has_pressure ? 2 : 1; }
  /// Of a step.
  int count() const { return stages * a_stage(); }
  /// Of sweep n, counted through the steps of a pass: its step and stage, and the number of its
  /// stage counted through these steps.
  int step(int n) const { return n / count(); }
  int stage(int n) const { return n % count() / a_stage(); }
  int stage_of_pass(int n) const { return n / a_stage(); }
  bool is_pressure(int n) const { return has_pressure && n % 2 == 0; }
  /// Sweeps that follow in the same step.
  int left(int n) const { return count() - 1 - n % count(); }
  /// Layers of halo of a part that is exchanged before each stage, or before each step.
  int halo(bool is_every_stage) const { return is_every_stage ? a_stage() : count(); }
  /// The sweep that computes a stage, counted through the steps of a pass.
  int of_stage(int stage) const { return (stage + 1) * a_stage() - 1; }
};

} // namespace dss
