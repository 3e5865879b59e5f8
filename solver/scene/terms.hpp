#pragma once
/// Terms that act on the bodies of a scene. Each function reads one key of the scene into the
/// problem.
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"
#include "solver/scene/place_selection.hpp"
#include "solver/scene/solid.hpp"

namespace dss {

/// Each function appends the terms of one list of the scene to the problem.
/// @throws InputError with file, JSON pointer and what is wrong (all functions of this file)
/// @param solids  gets the extra links of the law `solid`
void read_extra_links(const Node& node, const BodySurfaces& surfaces, Problem& problem,
                      Solids& solids);
void read_clamps(const Node& node, const BodySurfaces& surfaces, Problem& problem);
void read_initial_motions(const Node& node, const BodySurfaces& surfaces, Problem& problem);
Stabilization read_stabilization(const Node& node);

/// Gravity [m/s^2] minus the acceleration of the frame (an object of signals by axis). Either may
/// be absent.
std::array<Signal, 3> read_frame_acceleration(const std::optional<Node>& gravity,
                                              const std::optional<Node>& base);

/// Rotation vector of the frame, by axis [rad]: an object of signals that have derivatives.
std::array<Signal, 3> read_frame_rotation(const Node& node);

/// Refuses a clamp if its element starts with a velocity that the clamp forbids. Refuses a tensor
/// inertia with exactly one rotation clamped.
/// @throws InputError
void check_clamps(const Problem& problem, const Node& scene);

} // namespace dss
