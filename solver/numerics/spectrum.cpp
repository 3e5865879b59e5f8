#include "solver/numerics/spectrum.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace dss {
namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Stiffness and damping of a link at rest over (u_i, theta_i, u_j, theta_j).
struct LinkMatrices {
  Matrix12 k, c;
};

Eigen::Matrix3d arm_matrix(int axis, const Vec3& edge) {
  const Eigen::Vector3d arm = Eigen::Vector3d::Unit(axis) * edge[std::size_t(axis)] / 2;
  Eigen::Matrix3d m;
  m << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return m;
}

/// Both laws are the same to first order: gap = u_j - u_i + c_i x theta_i + c_j x theta_j, turn = theta_j - theta_i.
LinkMatrices link_matrices(int axis, const AxisConstants& constants, const Vec3& edge_i, const Vec3& edge_j) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), none = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 6, 12> strain;
  strain << -one, arm_matrix(axis, edge_i), one, arm_matrix(axis, edge_j), none, -one, none, one;
  const auto diagonal = [axis](double normal, double shear, const Vec3& rot) {
    Vector6 d;
    d << shear, shear, shear, rot[0], rot[1], rot[2];
    d[axis] = normal;
    return d;
  };
  const Vector6 k = diagonal(constants.k_normal, constants.k_shear, constants.k_rot);
  const Vector6 c = diagonal(constants.d_normal, constants.d_shear, constants.d_rot);
  return {strain.transpose() * k.asDiagonal() * strain, strain.transpose() * c.asDiagonal() * strain};
}

/// The linearised problem: kinds of links with their matrices, and every element's inverse inertia with zeros where it
/// is clamped.
struct Linearised {
  struct Link {
    std::size_t i, j, kind;
  };
  std::vector<LinkMatrices> kinds;
  std::vector<Link> links;
  std::vector<int> body;                ///< of each element
  std::vector<std::uint8_t> clamped;    ///< bits of Dof of each element
  std::vector<Vector6> inverse_inertia; ///< of each body

  explicit Linearised(const Problem& problem);
  Vector6 free_inverse_inertia(std::size_t e) const {
    Vector6 inverse = inverse_inertia[std::size_t(body[e])];
    for (int dof = 0; dof < 6; ++dof)
      if (clamped[e] >> dof & 1) inverse[dof] = 0;
    return inverse;
  }
};

Linearised::Linearised(const Problem& problem)
    : body(problem.lattice.element_count), clamped(problem.lattice.element_count) {
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) { body[e] = row.body; });
  for (const Clamp& clamp : problem.clamps) clamped[clamp.element] |= clamp.dofs;
  for (const Body& b : problem.bodies) {
    Vector6 inertia;
    inertia << b.mass, b.mass, b.mass, b.inertia[0], b.inertia[1], b.inertia[2];
    inverse_inertia.push_back(inertia.cwiseInverse());
    for (int axis = 0; axis < 3; ++axis)
      kinds.push_back(link_matrices(axis, b.axis[std::size_t(axis)], b.edge, b.edge));
  }
  const auto add = [&](std::size_t i, std::size_t j, std::size_t kind) { links.push_back({i, j, kind}); };
  problem.lattice.for_each_link(
      [&](std::size_t i, std::size_t j, int axis) { add(i, j, 3 * std::size_t(body[i]) + std::size_t(axis)); });
  for (const ExtraLink& extra : problem.extra_links) {
    add(extra.i, extra.j, kinds.size());
    kinds.push_back(link_matrices(extra.axis, extra.constants, problem.bodies[std::size_t(body[extra.i])].edge,
                                  problem.bodies[std::size_t(body[extra.j])].edge));
  }
}

double largest_eigenvalue(const Matrix12& matrix, const Vector12& scale) {
  const Matrix12 scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix12>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// Largest eigenvalue over the links' own pencils, each link with its share of its elements' inertia.
double pencil_bound(const Linearised& system, Matrix12 LinkMatrices::*part) {
  // Any split of the inertia gives a bound. In proportion to the links' diagonal entries it suits orthotropic links
  // too.
  std::vector<Vector6> diagonal(system.body.size(), Vector6::Zero());
  for (const auto& [i, j, kind] : system.links) {
    const Vector12 own = (system.kinds[kind].*part).diagonal();
    diagonal[i] += own.head<6>();
    diagonal[j] += own.tail<6>();
  }
  // Links alike in constants and in what their elements feel have the same pencil: few differ.
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
      // A degree of freedom that the link does not touch needs no inertia of it.
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

/// y = M^-1/2 A M^-1/2 x with A the assembled stiffness or damping.
class ScaledMatrix {
public:
  ScaledMatrix(const Linearised& system, Matrix12 LinkMatrices::*part, const Stabilization& stabilization)
      : system_(system), part_(part), scale_(6 * system.body.size()) {
    const bool is_stiffness = part == &LinkMatrices::k;
    const double u = is_stiffness ? stabilization.k : stabilization.d;
    const double theta = is_stiffness ? stabilization.k_rot : stabilization.d_rot;
    tie_ << u, u, u, theta, theta, theta;
    for (std::size_t e = 0; e < system.body.size(); ++e)
      scale_.segment<6>(Eigen::Index(6 * e)) = system.free_inverse_inertia(e).cwiseSqrt();
  }
  const Eigen::VectorXd& scale() const { return scale_; }
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd moved = scale_.cwiseProduct(x);
    Eigen::VectorXd result(x.size());
    for (Eigen::Index e = 0; e < x.size(); e += 6) result.segment<6>(e) = tie_.cwiseProduct(moved.segment<6>(e));
    for (const Linearised::Link& link : system_.links) {
      const auto i = Eigen::Index(6 * link.i), j = Eigen::Index(6 * link.j);
      Vector12 local;
      local << moved.segment<6>(i), moved.segment<6>(j);
      const Vector12 reaction = system_.kinds[link.kind].*part_ * local;
      result.segment<6>(i) += reaction.head<6>();
      result.segment<6>(j) += reaction.tail<6>();
    }
    return scale_.cwiseProduct(result);
  }

private:
  const Linearised& system_;
  Matrix12 LinkMatrices::*part_;
  Vector6 tie_;
  Eigen::VectorXd scale_;
};

/// Largest eigenvalue by Lanczos. Without reorthogonalisation: lost orthogonality repeats eigenvalues, it adds none
/// above the largest.
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
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
      ritz.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), n),
                                  Eigen::Map<Eigen::VectorXd>(off_diagonal.data(), n - 1));
      // |A x - theta x| of the Ritz vector x is beta times the last component of the small eigenvector.
      const double theta = ritz.eigenvalues()[n - 1], residual = beta * std::abs(ritz.eigenvectors()(n - 1, n - 1));
      bound = theta + residual;
      if (is_exhausted || residual <= 2e-4 * theta) break;
    }
    off_diagonal.push_back(beta);
    previous = v;
    v = next / beta;
  }
  return bound;
}

} // namespace

Spectrum spectrum_bound(const Problem& problem) {
  const Linearised system(problem);
  const Stabilization& tie = problem.stabilization;
  double tie_stiffness = 0, tie_damping = 0;
  for (const Vector6& inverse : system.inverse_inertia) {
    const double u = inverse[0], theta = inverse.tail<3>().maxCoeff();
    tie_stiffness = std::max({tie_stiffness, tie.k * u, tie.k_rot * theta});
    tie_damping = std::max({tie_damping, tie.d * u, tie.d_rot * theta});
  }
  return {std::sqrt(pencil_bound(system, &LinkMatrices::k) + tie_stiffness),
          pencil_bound(system, &LinkMatrices::c) + tie_damping, 0};
}

Spectrum krylov_spectrum(const Problem& problem) {
  const Linearised system(problem);
  Spectrum spectrum;
  spectrum.omega_max =
      std::sqrt(lanczos(ScaledMatrix(system, &LinkMatrices::k, problem.stabilization), spectrum.products));
  spectrum.damping = lanczos(ScaledMatrix(system, &LinkMatrices::c, problem.stabilization), spectrum.products);
  return spectrum;
}

} // namespace dss
