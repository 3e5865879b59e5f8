#include "solver/numerics/modes.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/linearised.hpp"
#include "solver/numerics/step_growth.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

namespace dss {

/// Degrees of freedom that depend on one another, with inertia scaled to 1: x'' + C x' + K x = 0.
/// The unit of time is such that no number of K or C exceeds 1. It is part of Modes::Piece and
/// therefore not local to this file.
struct Coupled {
  std::vector<Eigen::Index> dof; ///< 6 element + 0 .. 5
  Eigen::MatrixXd k, c;
};

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr double negligible = 1e-12; ///< share of a norm that counts as zero

/// Matrices of all elements; `rate` becomes one over the unit of time [1/s]. Clamped degrees of
/// freedom have rows and columns of zeros.
Coupled assembled(const Problem& problem, double& rate) {
  const Linearised system(problem);
  const auto size = Index(6 * system.body.size());
  Coupled all{std::vector<Index>(std::size_t(size)), MatrixXd::Zero(size, size),
              MatrixXd::Zero(size, size)};
  VectorXd scale(size);
  for (Index n = 0; n < size; ++n) all.dof[std::size_t(n)] = n;
  for (std::size_t e = 0; e < system.body.size(); ++e) {
    const auto at = Index(6 * e);
    scale.segment<6>(at) = system.free_inverse_inertia(e).cwiseSqrt();
    all.k.diagonal().segment<6>(at) = system.tie_stiffness;
    all.c.diagonal().segment<6>(at) = system.tie_damping;
  }
  const auto add = [](MatrixXd& to, const Matrix12& own, Index i, Index j) {
    to.block<6, 6>(i, i) += own.topLeftCorner<6, 6>();
    to.block<6, 6>(i, j) += own.topRightCorner<6, 6>();
    to.block<6, 6>(j, i) += own.bottomLeftCorner<6, 6>();
    to.block<6, 6>(j, j) += own.bottomRightCorner<6, 6>();
  };
  for (const auto& [i, j, kind] : system.links) {
    add(all.k, system.kinds[kind].k, Index(6 * i), Index(6 * j));
    add(all.c, system.kinds[kind].c, Index(6 * i), Index(6 * j));
  }
  for (const PressureTerm& term : system.pressures)
    for (const auto& [row, a] : term.parts)
      for (const auto& [column, b] : term.parts)
        all.k(Index(row), Index(column)) += term.weight * a * b;
  all.k = scale.asDiagonal() * all.k * scale.asDiagonal();
  all.c = scale.asDiagonal() * all.c * scale.asDiagonal();
  rate = std::max(std::sqrt(all.k.cwiseAbs().maxCoeff()), all.c.cwiseAbs().maxCoeff());
  if (rate > 0) all.k /= rate, all.k /= rate, all.c /= rate;
  return all;
}

/// Splits the problem into independent pieces: a plate in its plane and out of it, a bar along and
/// across. Degrees of freedom without links or ties are in no piece.
std::vector<Coupled> decoupled(const Coupled& all) {
  std::vector<Coupled> pieces;
  std::vector<bool> is_taken(all.dof.size());
  for (Index first = 0; first < all.k.rows(); ++first) {
    if (is_taken[std::size_t(first)] || (all.k(first, first) == 0 && all.c(first, first) == 0))
      continue;
    std::vector<Index> members = {first};
    is_taken[std::size_t(first)] = true;
    for (std::size_t n = 0; n < members.size(); ++n)
      for (Index other = 0; other < all.k.rows(); ++other)
        if (!is_taken[std::size_t(other)] &&
            (all.k(members[n], other) != 0 || all.c(members[n], other) != 0)) {
          is_taken[std::size_t(other)] = true;
          members.push_back(other);
        }
    std::sort(members.begin(), members.end());
    pieces.push_back({members, all.k(members, members), all.c(members, members)});
  }
  return pieces;
}

/// The mode of an eigenvector.
template <class Vector>
Mode mode_of(const Coupled& piece, const Vector& x) {
  const double size = x.squaredNorm();
  const double k = std::real(x.dot(piece.k * x)) / size, c = std::real(x.dot(piece.c * x)) / size;
  Index most = 0;
  x.cwiseAbs().maxCoeff(&most);
  const auto dof = piece.dof[std::size_t(most)];
  return {std::sqrt(std::max(0.0, k)), std::max(0.0, c), std::size_t(dof / 6), int(dof % 6)};
}

bool has_single_modes(const Coupled& piece) {
  const MatrixXd product = piece.k * piece.c;
  return (product - product.transpose()).norm() <= 1e-10 * piece.k.norm() * piece.c.norm();
}

/// Modes if stiffness and damping have the same eigenvectors; by falling frequency, without rigid
/// motions.
std::vector<Mode> single_modes(const Coupled& piece) {
  // If a frequency is multiple, eigenvectors of K need not be eigenvectors of C. Eigenvectors of a
  // general sum of both matrices are.
  const double k = piece.k.norm(), c = piece.c.norm();
  const SymmetricEigen both(c > 0 ? MatrixXd(piece.k + 0.618 * k / c * piece.c) : piece.k);
  std::vector<Mode> modes;
  for (Index n = piece.k.rows() - 1; n >= 0; --n)
    if (const Mode mode = mode_of(piece, both.vectors.col(n));
        mode.omega * mode.omega > negligible * k || mode.rate > negligible * c)
      modes.push_back(mode);
  return modes;
}

ExactLimit limit_of_single_modes(const std::vector<Mode>& modes, const Method& method) {
  ExactLimit limit;
  for (const Mode& mode : modes)
    if (const double dt = mode_step_limit(method, mode.omega, mode.rate, limit.dt); dt < limit.dt)
      limit = {dt, mode};
  return limit;
}

/// Eigenvalues of (omega x, x')' = (omega x', -K/omega (omega x) - C x'), rigid motions included.
Eigen::VectorXcd roots_of(const Coupled& piece) {
  const Index size = piece.k.rows();
  const double omega = std::sqrt(std::max(piece.k.norm(), 1e-300));
  MatrixXd matrix = MatrixXd::Zero(2 * size, 2 * size);
  matrix.topRightCorner(size, size).diagonal().setConstant(omega);
  matrix.bottomLeftCorner(size, size) = -piece.k / omega;
  matrix.bottomRightCorner(size, size) = -piece.c;
  return eigenvalues(matrix);
}

/// Eigenvector of lambda^2 x + lambda C x + K x = 0, by inverse iteration.
Eigen::VectorXcd eigenvector(const Coupled& piece, Complex lambda) {
  const Index size = piece.k.rows();
  Eigen::MatrixXcd matrix = piece.k.cast<Complex>() + lambda * piece.c.cast<Complex>();
  matrix.diagonal().array() += lambda * lambda * (1 + 1e-13); // not quite singular
  const Eigen::PartialPivLU<Eigen::MatrixXcd> factors(matrix);
  Eigen::VectorXcd x = Eigen::VectorXcd::LinSpaced(size, Complex(1, 0),
                                                   Complex(1, 1)); // start vector without symmetry
  for (int n = 0; n < 3; ++n) x = factors.solve(x).normalized();
  return x;
}

ExactLimit limit_of_roots(const Coupled& piece, const Eigen::VectorXcd& roots,
                          const Method& method) {
  const double largest = roots.cwiseAbs().maxCoeff();
  double dt = std::numeric_limits<double>::infinity();
  Complex worst = 0;
  for (Complex root : roots) {
    // Rigid motions have a double root of zero. It is computed as about the square root of
    // rounding.
    if (std::abs(root) <= 1e-6 * largest || root.imag() < 0) continue;
    if (std::abs(root.real()) <= negligible * largest) root.real(0); // undamped
    if (const double own = root_step_limit(method, root, dt); own < dt) dt = own, worst = root;
  }
  return std::isfinite(dt) ? ExactLimit{dt, mode_of(piece, eigenvector(piece, worst))}
                           : ExactLimit{};
}

/// Leapfrog and symplectic Euler: the h at which the largest eigenvalue of (h/I)^2 K + (h/R) C is
/// 1, by Newton's method from above. Each eigenvector gives the limit of its own mode.
ExactLimit limit_of_flipping_mode(const Coupled& piece, const Method& method) {
  const double of_k = 1 / (method.imaginary_limit * method.imaginary_limit),
               of_c = 1 / method.real_limit;
  const auto borne = [&](const Mode& mode) {
    const double k = of_k * mode.omega * mode.omega, c = of_c * mode.rate;
    return 2 / (c + std::sqrt(c * c + 4 * k));
  };
  constexpr int most_iterations = 30;
  Mode mode{std::sqrt(piece.k.norm()), piece.c.norm()};
  double h = borne(mode);
  for (int n = 0; n < most_iterations; ++n) {
    const SymmetricEigen solved(h * h * of_k * piece.k + h * of_c * piece.c);
    mode = mode_of(piece, solved.vectors.rightCols<1>());
    const double previous = std::exchange(h, borne(mode));
    if (std::abs(h - previous) <= 1e-12 * h || piece.c.norm() == 0) break;
  }
  return {h, mode};
}

} // namespace

/// A piece, and its results that do not depend on the method.
struct Modes::Piece {
  Coupled coupled;
  bool has_single_modes = false; ///< stiffness and damping have the same eigenvectors
  std::vector<Mode> modes{};     ///< single modes, by falling frequency; computed on first use
  Eigen::VectorXcd roots{};      ///< of the first-order form; computed on first use

  bool is_too_large(bool is_runge_kutta) const {
    const bool is_symmetric = !is_runge_kutta || has_single_modes;
    return coupled.dof.size() > (is_symmetric ? most_symmetric_unknowns : most_damped_unknowns);
  }
  ExactLimit step_limit(const Method& method) {
    if (method.is_unlimited()) return {};
    if (method.family != Method::Family::runge_kutta)
      return limit_of_flipping_mode(coupled, method);
    if (!has_single_modes) {
      if (roots.size() == 0) roots = roots_of(coupled);
      return limit_of_roots(coupled, roots, method);
    }
    if (modes.empty()) modes = single_modes(coupled);
    return limit_of_single_modes(modes, method);
  }
};

Modes::Modes(const Problem& problem) {
  // Dense matrices of larger problems are not worth their memory, even if they decouple.
  if (6 * problem.lattice.element_count > 2 * most_symmetric_unknowns) {
    pieces_.push_back({{std::vector<Index>(6 * problem.lattice.element_count), {}, {}}});
    return;
  }
  for (Coupled& piece : decoupled(assembled(problem, rate_))) {
    const bool commutes = has_single_modes(piece);
    pieces_.push_back({std::move(piece), commutes});
  }
}

Modes::~Modes() = default;

std::optional<ExactLimit> Modes::step_limit(const Method& method) {
  const bool is_runge_kutta = method.family == Method::Family::runge_kutta;
  ExactLimit least;
  std::size_t unknowns = 0;
  for (const Piece& piece : pieces_) {
    if (piece.is_too_large(is_runge_kutta)) return {};
    unknowns += piece.coupled.dof.size();
  }
  for (Piece& piece : pieces_)
    if (const ExactLimit own = piece.step_limit(method); own.dt < least.dt) least = own;
  least.unknowns = unknowns;
  least.mode.omega *= rate_;
  least.mode.rate *= rate_;
  if (std::isfinite(least.dt)) least.dt /= rate_;
  return least;
}

} // namespace dss
