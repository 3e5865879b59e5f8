#pragma once
/// Extreme eigenvalues of a problem linearised at rest: M x'' + C x' + K x = 0, six degrees of
/// freedom an element, without clamped ones.
#include "solver/model/problem.hpp"

namespace dss {

/// Extreme eigenvalues of a problem, or bounds of them.
struct Spectrum {
  double omega_max = 0; ///< square root of the largest eigenvalue of (K, M) [rad/s]
  double damping = 0;   ///< largest eigenvalue of (C, M) [1/s]
  /// b [s] such that C - b K has no negative eigenvalue: the damping rate of a mode of frequency
  /// omega is at least b omega^2.
  double least_damping = 0;
  long products = 0; ///< matrix-vector products used
};

/// Upper bounds by the element-by-element theorem (I. Fried, AIAA Journal 10 (1972) 219-221).
/// Distribute the inertia of each element among its links. Then no eigenvalue of the assembled
/// pencil exceeds the largest one of the 12 x 12 pencils of single links. Stabilization adds its
/// own largest eigenvalue. Cost: one pass over the links and one small eigenproblem for each kind
/// of link.
Spectrum spectrum_bound(const Problem& problem);

/// Eigenvalues by the Lanczos process on the assembled links. The relative error of omega_max is
/// about 1e-4. The residual of the eigenvector is added, so the result errs on the safe side.
Spectrum krylov_spectrum(const Problem& problem);

} // namespace dss
