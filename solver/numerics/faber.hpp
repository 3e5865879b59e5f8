#pragma once
/// Exponential method of a linear problem as a Runge-Kutta table: the polynomial of a step is
/// exp(z) to rounding wherever eigenvalues of the problem may lie.
#include "solver/numerics/method.hpp"
#include "solver/numerics/spectrum.hpp"

namespace dss {

/// The method for a step and a spectrum. Its stages are the recurrence of a Chebyshev expansion on
/// an ellipse around the spectrum (C. W. Clenshaw, MTAC 9 (1955) 118-120), each divided by what it
/// makes of a constant: so stages are combinations of the state, the two stages before and one
/// slope, and loads need no factors.
/// @param spectrum  bounds; `dt`: [s]
/// @return a method without stages if more than most_faber_stages are needed
Method faber(const Spectrum& spectrum, double dt);

inline constexpr int most_faber_stages = 400;

} // namespace dss
