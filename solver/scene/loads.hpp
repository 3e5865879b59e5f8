#pragma once
/// Loads of a scene.
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"
#include "solver/scene/place_selection.hpp"
#include "solver/scene/solid.hpp"

namespace dss {

/// Appends the loads of a list to the problem. A load along a line becomes one load an element.
/// @throws InputError with file, JSON pointer and what is wrong
void read_loads(const Node& node, const Solids& solids, const BodySurfaces& surfaces,
                Problem& problem);

} // namespace dss
