#pragma once
/// Effect of one step of a method on a single mode, and the largest step at which no mode grows.
#include "solver/numerics/method.hpp"

#include <complex>
#include <limits>

namespace dss {

/// A growth below this a step counts as none: a million steps do not show it.
constexpr double unseen_growth = 1e-12;

/// Amplification |R(z)| of an explicit Runge-Kutta method for y' = lambda y, z = h lambda. It runs
/// the method's own table from y = 1.
double amplification(const Method& method, std::complex<double> z);

/// Spectral radius of one step of an explicit method on the mode x'' + rate x' + omega^2 x = 0.
/// @param h      step [s]
/// @param omega  frequency [rad/s]
/// @param rate   damping rate [1/s]
double spectral_radius(const Method& method, double h, double omega, double rate);

/// Step limit [s] of an explicit method on the mode x'' + rate x' + omega^2 x = 0. The limit is the
/// first step, upwards from 0, at which the spectral radius exceeds 1 + unseen_growth. It is 0 if
/// the method lets the mode grow at every step size, and infinite for omega = rate = 0 and for
/// implicit methods.
/// @param omega, rate  [rad/s], [1/s], not negative; rate = 2 zeta omega for the damping ratio zeta
/// @param enough       a limit above this [s] may be returned as infinite
double mode_step_limit(const Method& method, double omega, double rate,
                       double enough = std::numeric_limits<double>::infinity());

/// Step limit of a Runge-Kutta method on y' = root y; root [1/s] has no positive real part.
/// Infinite for implicit methods.
double root_step_limit(const Method& method, std::complex<double> root,
                       double enough = std::numeric_limits<double>::infinity());

} // namespace dss
