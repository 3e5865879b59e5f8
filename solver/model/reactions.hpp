#pragma once
/// What clamps exert on bodies.
#include "solver/model/problem.hpp"
#include "solver/reference/dynamics.hpp"

#include <span>

namespace dss {

/// Force [N] and moment about the frame's origin [N m] that all clamps together exert on the
/// bodies, in global axes.
struct Reactions {
  Vec3 force{}, moment{};
};

/// They balance what links, loads and the frame's acceleration do to clamped degrees of freedom. So
/// in a state of rest, together with all loads they are zero. The gyroscopic moment of an element
/// that is held about one axis and turns about another is left out.
/// @param terms    energy_terms (energy.hpp) of the problem
/// @param fields   the state as `placed` gives it
/// @param signals  a row at the time of the state (solver/numerics/signal_rows.hpp)
Reactions clamp_reactions(const Problem& problem, reference::Dynamics<double>& terms,
                          std::span<const double> fields, std::span<const double> signals);

} // namespace dss
