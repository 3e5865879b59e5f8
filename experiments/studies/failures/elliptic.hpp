#pragma once
/// Jacobi's elliptic functions, which the C++ standard library does not have.

namespace dss {

/// Values of the three functions.
struct Jacobi {
  double sn = 0, cn = 0, dn = 0;
};

/// sn, cn and dn of the argument u and the modulus k, 0 <= k < 1. Method: arithmetic-geometric mean
/// and descending recurrence of the amplitude (Abramowitz and Stegun 16.4; DLMF 22.20(ii)).
/// Accurate to about rounding. Other tables use the parameter m = k^2.
Jacobi jacobi(double u, double k);

} // namespace dss
