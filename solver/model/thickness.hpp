#pragma once
/// How many layers of elements bodies have.
#include "solver/model/problem.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Axes along which an element has no neighbour, as bits 1 << axis: the body is one layer thick
/// there.
using ThinAxes = std::uint8_t;

/// Of each element.
/// @param joints  numbers of the extra links that lead to neighbours, too
std::vector<ThinAxes> thin_axes(const Problem& problem, std::span<const std::size_t> joints = {});

/// Notes on bodies whose links make them softer than their material, one line a body. If links are
/// beams, a body has half of its material's shear modulus where elements have neighbours along two
/// axes: an element is free to turn by half of the shear, so the links along both axes share it in
/// series.
std::vector<std::string> softness_notes(const Problem& problem);

} // namespace dss
