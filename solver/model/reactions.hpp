#pragma once
/// What clamps exert on bodies.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/reference/dynamics.hpp"

#include <optional>
#include <span>

namespace dss {

/// Force [N] and moment about the frame's origin [N m] that all clamps together exert on the
/// bodies, in global axes. They balance what links, loads and the frame's acceleration do to
/// clamped degrees of freedom. So in a state of rest, together with all loads they are zero. The
/// gyroscopic moment of an element that is held about one axis and turns about another is left out.
struct Reactions {
  Vec3 force{}, moment{};
};

struct EnergyAndReactions {
  double energy_j = 0;                ///< as total_energy (energy.hpp)
  std::optional<Reactions> reactions; ///< absent without clamps
};
/// Both need the oracle's terms, which are made once.
/// @param state      field_count numbers an element (kernels/fields.hpp)
/// @param equations  equations that the state comes from
/// @param signals    a row at the time of the state (solver/numerics/signal_rows.hpp)
EnergyAndReactions energy_and_reactions(const Problem& problem, std::span<const double> state,
                                        Rotation equations, std::span<const double> signals);
/// The same from terms that were made before (energy_terms).
/// @param fields  the state as `placed` gives it
EnergyAndReactions energy_and_reactions(const Problem& problem, reference::Dynamics<double>& terms,
                                        std::span<const double> fields,
                                        std::span<const double> signals);

} // namespace dss
