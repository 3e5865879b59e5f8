#pragma once
/// Checks whether a static problem has a single answer.
#include "solver/model/problem.hpp"

#include <cstdint>
#include <string>

namespace dss {

/// Returns an empty text if clamps and ties hold every body, or every group of linked bodies,
/// against rigid motions; otherwise one line with the body and the motion. Links without rotational
/// springs may allow further motions. Such a motion shows as a zero pivot of the stiffness, not
/// here.
/// @param dofs  bits of Dof that may move
std::string why_not_held(const Problem& problem, std::uint8_t dofs = dof_all);

} // namespace dss
