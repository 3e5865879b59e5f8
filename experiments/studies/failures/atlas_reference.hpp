#pragma once
/// Reference states for the cells of the failure atlas.
#include "experiments/studies/failures/failure_case.hpp"
#include "solver/scene/scene.hpp"

#include <map>
#include <vector>

namespace dss {

/// References of one scene with its overrides. Each is computed once.
class AtlasReferences {
public:
  /// All three arguments must outlive this object.
  AtlasReferences(const AtlasReference& reference, const Scene& scene,
                  const std::vector<Override>& set)
      : reference_(reference), scene_(scene), set_(set) {}
  /// State at time t [s], 13 numbers per element. @throws InputError if the oracle does not
  /// converge
  const std::vector<double>& at(double t);

private:
  std::vector<double> closed(double t) const;
  std::vector<double> other_scene(double t) const;

  const AtlasReference& reference_;
  const Scene& scene_;
  const std::vector<Override>& set_;
  std::map<double, std::vector<double>> states_;
};

/// The oracle's state (long double, rk4) at time t [s], 13 numbers per element. The step is halved
/// until the state changes by less than `tolerance`.
/// @throws InputError if 12 halvings are not enough
std::vector<double> converged_state(const Problem& problem, double t, double tolerance);

/// Gives each expected quaternion the sign that is closer to `actual`: q and -q are the same
/// orientation.
void align_turns(std::vector<double>& expected, const std::vector<double>& actual);

} // namespace dss
