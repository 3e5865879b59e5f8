#pragma once
/// Step limit of explicit methods in a state of motion. Links that stretch or bend may become
/// stiffer than at rest.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"

#include <span>

namespace dss {

/// Larger problems have no limit in a state: it costs some 200 evaluations.
constexpr std::size_t stability_state_elements = 2'000;

/// Step limit [s] in a state: the limit at rest, divided by the growth of the largest natural
/// frequency or of the largest damping rate, whichever grew more. Both are estimated in the same
/// way at rest and in the state, by an Arnoldi iteration on differences of the oracle's
/// accelerations. An estimate; gyroscopic terms are not included.
/// @param rotation       description of rotations of the run
/// @param state          field_count numbers an element, with quaternions; finite
/// @param limit_at_rest  of stable_step [s]
double stable_step_at_state(const Problem& problem, Rotation rotation,
                            std::span<const double> state, double limit_at_rest);

} // namespace dss
