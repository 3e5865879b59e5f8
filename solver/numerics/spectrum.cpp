#include "solver/numerics/spectrum.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/linearised.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace dss {
namespace {

double largest_eigenvalue(const Matrix12& matrix, const Vector12& scale) {
  const Matrix12 scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return SymmetricEigen(scaled).values.maxCoeff();
}

/// Largest eigenvalue of the pencils of single links, each with a share of its elements' inertia.
double pencil_bound(const Linearised& system, Matrix12 LinkMatrices::*part) {
  // Every split of the inertia gives a bound. A split in proportion to the diagonal entries suits
  // orthotropic links too.
  std::vector<Vector6> diagonal(system.body.size(), Vector6::Zero());
  for (const auto& [i, j, kind] : system.links) {
    const Vector12 own = (system.kinds[kind].*part).diagonal();
    diagonal[i] += own.head<6>();
    diagonal[j] += own.tail<6>();
  }
  // Links with equal constants and equal shares have the same pencil, so few pencils differ.
  std::set<std::array<double, 13>> seen;
  double largest = 0;
  for (const auto& [i, j, kind] : system.links) {
    const Matrix12& matrix = system.kinds[kind].*part;
    Vector12 scale;
    scale << diagonal[i].cwiseProduct(system.free_inverse_inertia(i)),
        diagonal[j].cwiseProduct(system.free_inverse_inertia(j));
    std::array<double, 13> key;
    key[12] = double(kind);
    for (int dof = 0; dof < 12; ++dof) {
      // A degree of freedom that the link does not touch gets no share of the inertia.
      scale[dof] = matrix(dof, dof) > 0 ? std::sqrt(scale[dof] / matrix(dof, dof)) : 0;
      key[std::size_t(dof)] = scale[dof];
    }
    if (!seen.insert(key).second) continue;
    const double own = largest_eigenvalue(matrix, scale);
    if (!std::isfinite(own)) return own;
    largest = std::max(largest, own);
  }
  return largest;
}

/// y = M^-1/2 A M^-1/2 x, where A is the assembled stiffness or damping.
class ScaledMatrix {
public:
  ScaledMatrix(const Linearised& system, Matrix12 LinkMatrices::*part)
      : system_(system), part_(part),
        tie_(part == &LinkMatrices::k ? system.tie_stiffness : system.tie_damping),
        scale_(6 * system.body.size()) {
    for (std::size_t e = 0; e < system.body.size(); ++e)
      scale_.segment<6>(Eigen::Index(6 * e)) = system.free_inverse_inertia(e).cwiseSqrt();
  }
  const Eigen::VectorXd& scale() const { return scale_; }
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd moved = scale_.cwiseProduct(x);
    Eigen::VectorXd result(x.size());
    for (Eigen::Index e = 0; e < x.size(); e += 6)
      result.segment<6>(e) = tie_.cwiseProduct(moved.segment<6>(e));
    for (const Linearised::Link& link : system_.links) {
      const auto i = Eigen::Index(6 * link.i), j = Eigen::Index(6 * link.j);
      Vector12 local;
      local << moved.segment<6>(i), moved.segment<6>(j);
      const Vector12 reaction = system_.kinds[link.kind].*part_ * local;
      result.segment<6>(i) += reaction.head<6>();
      result.segment<6>(j) += reaction.tail<6>();
    }
    if (part_ == &LinkMatrices::k) add_pressures(moved, result);
    return scale_.cwiseProduct(result);
  }

private:
  void add_pressures(const Eigen::VectorXd& moved, Eigen::VectorXd& result) const {
    for (const PressureTerm& term : system_.pressures) {
      double strain = 0;
      for (const auto& [dof, coefficient] : term.parts)
        strain += coefficient * moved[Eigen::Index(dof)];
      for (const auto& [dof, coefficient] : term.parts)
        result[Eigen::Index(dof)] += term.weight * strain * coefficient;
    }
  }
  const Linearised& system_;
  Matrix12 LinkMatrices::*part_;
  Vector6 tie_;
  Eigen::VectorXd scale_;
};

/// Largest eigenvalue by the Lanczos process, without reorthogonalisation. Lost orthogonality
/// repeats eigenvalues but adds none above the largest.
double lanczos(const ScaledMatrix& matrix, long& products) {
  constexpr int most_products = 300, check_every = 10;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(matrix.scale().size());
  for (Eigen::Index n = 0; n < v.size(); ++n) v[n] = matrix.scale()[n] == 0 ? 0 : normal(generator);
  if (v.size() == 0 || v.norm() == 0) return 0;
  v.normalize();

  Eigen::VectorXd previous = Eigen::VectorXd::Zero(v.size());
  std::vector<double> diagonal, off_diagonal;
  double beta = 0, bound = 0;
  for (int n = 1; n <= most_products; ++n) {
    Eigen::VectorXd next = matrix * v;
    ++products;
    diagonal.push_back(v.dot(next));
    next -= diagonal.back() * v + beta * previous;
    beta = next.norm();
    if (!std::isfinite(beta)) return beta;
    const bool is_exhausted = beta <= 1e-13 * std::abs(diagonal.front());
    if (is_exhausted || n % check_every == 0) {
      const SymmetricEigen ritz(Eigen::Map<Eigen::VectorXd>(diagonal.data(), n),
                                Eigen::Map<Eigen::VectorXd>(off_diagonal.data(), n - 1));
      // The residual |A x - theta x| of the Ritz vector x is beta times the last component of the
      // small eigenvector.
      const double theta = ritz.values[n - 1],
                   residual = beta * std::abs(ritz.vectors(n - 1, n - 1));
      bound = theta + residual;
      if (is_exhausted || residual <= 2e-4 * theta) break;
    }
    off_diagonal.push_back(beta);
    previous = v;
    v = next / beta;
  }
  return bound;
}

/// Largest b [s] such that every spring of constant k has a damper of at least b k beside it.
double least_damping(const Linearised& system) {
  double least = std::numeric_limits<double>::infinity();
  for (const Linearised::Link& link : system.links)
    least = std::min(least, system.kinds[link.kind].least_damping);
  for (int dof = 0; dof < 6; ++dof)
    if (system.tie_stiffness[dof] > 0)
      least = std::min(least, system.tie_damping[dof] / system.tie_stiffness[dof]);
  return std::isfinite(least) ? least : 0;
}

} // namespace

Spectrum spectrum_bound(const Problem& problem) {
  const Linearised system(problem);
  double tie_stiffness = 0, tie_damping = 0;
  const double lightest =
      system.mass_ratio.empty() ? 1 : std::min(1.0, std::ranges::min(system.mass_ratio));
  for (const Vector6& of_body : system.inverse_inertia) {
    const Vector6 inverse = of_body / lightest;
    tie_stiffness = std::max(tie_stiffness, inverse.cwiseProduct(system.tie_stiffness).maxCoeff());
    tie_damping = std::max(tie_damping, inverse.cwiseProduct(system.tie_damping).maxCoeff());
  }
  return {std::sqrt(pencil_bound(system, &LinkMatrices::k_bound) + tie_stiffness),
          pencil_bound(system, &LinkMatrices::c) + tie_damping, least_damping(system), 0};
}

Spectrum krylov_spectrum(const Problem& problem) {
  const Linearised system(problem);
  Spectrum spectrum;
  spectrum.omega_max =
      std::sqrt(lanczos(ScaledMatrix(system, &LinkMatrices::k), spectrum.products));
  spectrum.damping = lanczos(ScaledMatrix(system, &LinkMatrices::c), spectrum.products);
  spectrum.least_damping = least_damping(system);
  return spectrum;
}

} // namespace dss
