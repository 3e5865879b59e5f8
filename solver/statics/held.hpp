#pragma once
/// Whether a problem without motion has one answer.
#include "solver/model/problem.hpp"

#include <cstdint>
#include <string>

namespace dss {

/// Empty if clamps and ties hold every body, or every group of linked ones, against rigid motions, else one line that names the body and the
/// motion. What links without rotational springs let through besides is a zero pivot of the stiffness.
/// @param dofs  bits of Dof that may move
std::string why_not_held(const Problem& problem, std::uint8_t dofs = dof_all);

} // namespace dss
