#pragma once
/// What one step of a method does to a single mode, and up to which step it lets none grow.
#include "solver/numerics/method.hpp"

#include <complex>
#include <limits>

namespace dss {

/// A growth of less than this a step counts as none: a million steps do not show it.
constexpr double unseen_growth = 1e-12;

/// Amplification |R(z)| of a Runge-Kutta method for y' = lambda y, z = h lambda: its own table run from y = 1.
double amplification(const Method& method, std::complex<double> z);

/// Spectral radius of one step of an explicit method on the mode x'' + rate x' + omega^2 x = 0; h is the step [s], omega
/// [rad/s], rate [1/s].
double spectral_radius(const Method& method, double h, double omega, double rate);

/// Step limit [s] of an explicit method on that mode; omega and rate are not negative. With damping ratio zeta, rate = 2
/// zeta omega. The limit is the first step, upwards from 0, at which the spectral radius exceeds 1 + unseen_growth; 0 for
/// a method that lets the mode grow however small the step; infinite for omega = rate = 0, and for implicit methods.
/// @param enough  a limit above this [s] may be given as infinite
double mode_step_limit(const Method& method, double omega, double rate,
                       double enough = std::numeric_limits<double>::infinity());

/// The same of a Runge-Kutta method on y' = root y; root [1/s] has no positive real part.
double root_step_limit(const Method& method, std::complex<double> root,
                       double enough = std::numeric_limits<double>::infinity());

} // namespace dss
