#pragma once
/// Bessel functions of the first kind, all orders at once.
#include <cstddef>
#include <span>

namespace dss {

/// Fills values[n] = J_n(z), n = 0, 1, ...; errors are some units of rounding of 1. Miller's
/// downward recurrence, normalised by J_0 + 2 J_2 + 2 J_4 + ... = 1. Source: M. Abramowitz, I. A.
/// Stegun, Handbook of Mathematical Functions (1964), section 9.12.
/// @param z  not negative
/// @param values  at least bessel_orders(z), so that the last one is zero to rounding
void bessel_j(double z, std::span<double> values);

/// Orders n from which on J_n(z) is below 1e-18.
std::size_t bessel_orders(double z);

} // namespace dss
