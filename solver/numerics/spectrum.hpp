#pragma once
/// Extreme eigenvalues of a problem linearised at rest: M x'' + C x' + K x = 0, six degrees of freedom an element,
/// clamps removed.
#include "solver/model/problem.hpp"

namespace dss {

struct Spectrum {
  double omega_max = 0; ///< square root of the largest eigenvalue of (K, M) [rad/s]
  double damping = 0;   ///< largest eigenvalue of (C, M) [1/s]
  double least_damping =
      0; ///< b [s] such that C - b K has no negative eigenvalue: no mode of frequency omega is damped at less than b omega^2
  long products = 0; ///< matrix-vector products spent
};

/// Upper bounds by the element-by-element theorem: with each element's inertia shared out among its links, no
/// eigenvalue of the assembled pencil exceeds the largest of the single links' 12 x 12 pencils. (I. Fried, AIAA Journal
/// 10 (1972) 219-221.) Stabilization adds its own largest eigenvalue. One pass over the links, one small eigenproblem
/// for each kind of link.
Spectrum spectrum_bound(const Problem& problem);

/// The eigenvalues themselves by the Lanczos process on the assembled links: relative error about 1e-4 in omega_max, to
/// which the residual of the eigenvector is added, so that the figure errs to the safe side.
Spectrum krylov_spectrum(const Problem& problem);

} // namespace dss
