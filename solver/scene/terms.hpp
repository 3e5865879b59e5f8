#pragma once
/// What acts on the bodies of a scene: each function reads one key of the scene into the problem.
#include "solver/model/problem.hpp"
#include "solver/scene/json/node.hpp"

namespace dss {

/// A number (constant), or one of {"constant"}, {"ramp"}, {"harmonic"}, {"table"} with an optional "offset".
Signal read_signal(const Node& node);

void read_extra_links(const Node& node, Problem& problem);
void read_clamps(const Node& node, Problem& problem);
void read_loads(const Node& node, Problem& problem);
void read_initial_motions(const Node& node, Problem& problem);
Stabilization read_stabilization(const Node& node);

/// Gravity [m/s^2] minus the acceleration of the frame, which is an object of signals by axis; either may be absent.
std::array<Signal, 3> read_frame_acceleration(const std::optional<Node>& gravity, const std::optional<Node>& base);

/// Refuses a clamp whose element starts with a velocity it forbids, and a tensor inertia of which one rotation is held.
void check_clamps(const Problem& problem, const Node& scene);

} // namespace dss
