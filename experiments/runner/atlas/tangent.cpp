#include "experiments/runner/atlas/tangent.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/colouring.hpp"
#include "solver/reference/dynamics.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace dss {
namespace {

using Real = long double; // differences lose half of the digits

/// Generalised forces of states without motion.
class Forces {
public:
  explicit Forces(const Problem& problem)
      : problem_(problem), dynamics_(problem), rates_(problem.lattice.element_count * field_count) {
    const double end = problem.dt * double(problem.steps);
    for (const Signal& signal : problem.frame_acceleration) signals_.push_back(signal(end));
    for (const Load& load : problem.loads) signals_.push_back(load.signal(end));
    problem.lattice.for_each_element([&](std::size_t, const Row& row, int) { body_.push_back(row.body); });
  }
  /// Accelerations times inertia, 6 an element; clamped ones are 0.
  std::vector<Real> operator()(const std::vector<Real>& state) {
    dynamics_.rates(state, signals_, rates_);
    std::vector<Real> forces(6 * body_.size());
    for (std::size_t e = 0; e < body_.size(); ++e) {
      const Body& body = problem_.bodies[std::size_t(body_[e])];
      for (std::size_t a = 0; a < 3; ++a) {
        forces[6 * e + a] = Real(body.mass) * rates_[e * field_count + vx + a];
        forces[6 * e + 3 + a] = Real(body.inertia[a]) * rates_[e * field_count + wx + a];
      }
    }
    return forces;
  }

private:
  const Problem& problem_;
  reference::Dynamics<Real> dynamics_;
  std::vector<Real> rates_;
  std::vector<double> signals_;
  std::vector<int> body_;
};

/// Moves one degree of freedom of an element: along an axis, or about it in space.
template <class T>
void move(T* fields, int dof, T by) {
  if (dof < 3) {
    fields[ux + dof] += by;
    return;
  }
  const T half = std::sin(by / 2), less = -2 * std::sin(by / 4) * std::sin(by / 4); // cos(by / 2) - 1
  const int a = dof - 3, b = (a + 1) % 3, c = (a + 2) % 3;
  const T s = fields[qs], x = fields[qx + a], y = fields[qx + b], z = fields[qx + c];
  fields[qs] = s + less * (1 + s) - half * x;
  fields[qx + a] = x + less * x + half * (1 + s);
  fields[qx + b] = y + less * y - half * z;
  fields[qx + c] = z + less * z + half * y;
}

} // namespace

FreeDofs free_dofs(const Problem& problem) {
  std::vector<std::uint8_t> clamped(problem.lattice.element_count, 0);
  for (const Clamp& clamp : problem.clamps) clamped[clamp.element] |= clamp.dofs;
  FreeDofs dofs;
  std::vector<double> inertia;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    const Body& body = problem.bodies[std::size_t(row.body)];
    for (std::size_t d = 0; d < 6; ++d) {
      const bool is_free = (clamped[e] >> d & 1) == 0;
      dofs.index.push_back(is_free ? Eigen::Index(inertia.size()) : -1);
      if (!is_free) continue;
      dofs.dof.push_back(6 * e + d);
      inertia.push_back(d < 3 ? body.mass : body.inertia[d - 3]);
    }
  });
  if (inertia.empty()) throw InputError(fmt::format("{}: every degree of freedom is clamped", problem.name));
  dofs.inertia = Eigen::Map<Eigen::VectorXd>(inertia.data(), Eigen::Index(inertia.size()));
  return dofs;
}

Eigen::SparseMatrix<double> tangent_stiffness(const Problem& problem, const FreeDofs& dofs,
                                              const std::vector<double>& state) {
  const auto near = reference::neighbourhoods(problem);
  Forces forces(problem);
  const std::vector<Real> here(state.begin(), state.end());
  const Real angle = 1e-6L, length = angle * Real(shortest_edge(problem));
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::vector<std::size_t>& colour : reference::colour_groups(near))
    for (int d = 0; d < 6; ++d) {
      const Real step = d < 3 ? length : angle;
      std::vector<Real> ahead = here, behind = here;
      for (const std::size_t e : colour) {
        move(&ahead[e * field_count], d, step);
        move(&behind[e * field_count], d, -step);
      }
      const std::vector<Real> above = forces(ahead), below = forces(behind);
      for (const std::size_t e : colour) {
        const Eigen::Index column = dofs.index[6 * e + std::size_t(d)];
        if (column < 0) continue;
        for (const std::size_t n : near[e])
          for (std::size_t row = 6 * n; row < 6 * n + 6; ++row)
            if (dofs.index[row] >= 0 && above[row] != below[row])
              entries.emplace_back(dofs.index[row], column, double((below[row] - above[row]) / (2 * step)));
      }
    }
  Eigen::SparseMatrix<double> stiffness(dofs.inertia.size(), dofs.inertia.size());
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> transposed = stiffness.transpose();
  return (stiffness + transposed) / 2;
}

std::vector<double> equilibrium(const Problem& problem, const FreeDofs& dofs, std::vector<double> state) {
  constexpr int most_iterations = 50;
  Forces forces(problem);
  const double edge = shortest_edge(problem);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(tangent_stiffness(problem, dofs, state));
    if (factors.info() != Eigen::Success) break;
    const std::vector<Real> all = forces({state.begin(), state.end()});
    Eigen::VectorXd residual(dofs.inertia.size());
    for (std::size_t n = 0; n < dofs.dof.size(); ++n) residual[Eigen::Index(n)] = double(all[dofs.dof[n]]);
    const Eigen::VectorXd step = factors.solve(residual);
    double largest = 0;
    for (std::size_t n = 0; n < dofs.dof.size(); ++n) {
      const int d = int(dofs.dof[n] % 6);
      move(&state[dofs.dof[n] / 6 * field_count], d, step[Eigen::Index(n)]);
      largest = std::max(largest, std::abs(step[Eigen::Index(n)]) / (d < 3 ? edge : 1));
    }
    if (!std::isfinite(largest)) break;
    if (largest < 1e-12) return state;
  }
  throw InputError(
      fmt::format("{}: no equilibrium was found in {} iterations; give smaller loads, or clamp what floats",
                  problem.name, most_iterations));
}

Eigen::VectorXd smallest_eigenvalues(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& inertia,
                                     int count, double shift) {
  constexpr int most_iterations = 500;
  const Eigen::VectorXd root = inertia.cwiseSqrt();
  const Eigen::Index size = std::min<Eigen::Index>(2 * count + 8, inertia.size());
  Eigen::SparseMatrix<double> shifted = stiffness;
  for (Eigen::Index n = 0; n < inertia.size(); ++n) shifted.coeffRef(n, n) -= shift * inertia[n];
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(shifted);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd basis = Eigen::MatrixXd::NullaryExpr(inertia.size(), size, [&] { return normal(generator); });
  Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
  for (int iteration = 0; iteration < most_iterations && factors.info() == Eigen::Success; ++iteration) {
    // Orthonormal over the inertia, then the largest eigenvalues of the flexibility in that space: unlike the smallest ones of the stiffness
    // they do not drown in the rounding of the largest.
    const Eigen::MatrixXd scaled = root.asDiagonal() * basis;
    const Eigen::MatrixXd q =
        Eigen::HouseholderQR<Eigen::MatrixXd>(scaled).householderQ() * Eigen::MatrixXd::Identity(inertia.size(), size);
    const Eigen::MatrixXd moved = factors.solve(root.asDiagonal() * q);
    const Eigen::MatrixXd small = (root.asDiagonal() * q).transpose() * moved;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz((small + small.transpose()) / 2);
    basis = moved * ritz.eigenvectors();
    const Eigen::VectorXd now = ritz.eigenvalues().tail(count).reverse().cwiseInverse().array() + shift;
    const double change = (now - values).cwiseAbs().maxCoeff();
    values = now;
    if (change <= 1e-11 * values.cwiseAbs().maxCoeff()) return values;
  }
  throw InputError("the smallest natural frequencies were not found: is something free to float?");
}

} // namespace dss
