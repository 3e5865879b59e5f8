#pragma once
/// The states that cells of an atlas are compared with.
#include "experiments/runner/atlas/failure_case.hpp"
#include "solver/scene/scene.hpp"

#include <map>
#include <vector>

namespace dss {

/// References of one scene with its overrides, each computed once.
class AtlasReferences {
public:
  /// All three outlive it.
  AtlasReferences(const AtlasReference& reference, const Scene& scene, const std::vector<Override>& set)
      : reference_(reference), scene_(scene), set_(set) {}
  /// State at time t [s]. @throws InputError if the oracle does not converge
  const std::vector<double>& at(double t);

private:
  std::vector<double> closed(double t) const;
  std::vector<double> other_scene(double t) const;

  const AtlasReference& reference_;
  const Scene& scene_;
  const std::vector<Override>& set_;
  std::map<double, std::vector<double>> states_;
};

/// The oracle's state (long double, rk4) at time t [s], with a step that is halved until the state changes by less than `tolerance`.
/// @throws InputError if twelve halvings do not suffice
std::vector<double> converged_state(const Problem& problem, double t, double tolerance);

/// Gives each quaternion the sign that is nearer to that of `actual`: both signs are the same orientation.
void align_turns(std::vector<double>& expected, const std::vector<double>& actual);

} // namespace dss
