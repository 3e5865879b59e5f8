#pragma once
/// Jacobi's elliptic functions, which neither the standard library nor the packages here have.

namespace dss {

struct Jacobi {
  double sn = 0, cn = 0, dn = 0;
};

/// sn, cn and dn of argument u and modulus k, 0 <= k < 1, by the arithmetic-geometric mean and the descending recurrence of the amplitude
/// (Abramowitz and Stegun 16.4; DLMF 22.20(ii)). Near rounding.
/// The parameter of other tables is m = k^2.
Jacobi jacobi(double u, double k);

} // namespace dss
