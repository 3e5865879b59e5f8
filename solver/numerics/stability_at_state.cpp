#include "solver/numerics/stability_at_state.hpp"

#include "solver/model/energy.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace dss {
namespace {

using reference::Orientation;

constexpr int most_products = 24;
/// Largest displacement of a difference, in edges.
constexpr double difference = 1e-6;

/// The matrices M^-1 K and M^-1 C of a state, by their products with vectors. A vector has u and l
/// theta of each element, where l is the radius of gyration: both then count alike.
class StateMatrices {
public:
  StateMatrices(const Problem& problem, Rotation rotation, std::span<const double> state)
      : dynamics_(energy_terms(problem, rotation)), state_(placed(dynamics_, state)),
        size_(difference * shortest_edge(problem)), gyration_(dynamics_.element_count()),
        signals_(signal_count(problem), 0.0) {
    problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
      const Body& body = problem.bodies[std::size_t(row.body)];
      gyration_[e] = std::sqrt(*std::ranges::max_element(body.inertia) / body.mass);
    });
    for (std::size_t e = 0; e < gyration_.size(); ++e) {
      double* fields = &state_[e * field_count];
      for (int axis = 0; axis < 3; ++axis) fields[vx + axis] = fields[wx + axis] = 0;
    }
  }
  Eigen::Index unknowns() const { return Eigen::Index(6 * gyration_.size()); }

  Eigen::VectorXd stiffness_times(const Eigen::VectorXd& x) { return times(x, true); }
  Eigen::VectorXd damping_times(const Eigen::VectorXd& x) { return times(x, false); }

private:
  /// A central difference: it is exact for dampers, and gyroscopic terms cancel.
  Eigen::VectorXd times(const Eigen::VectorXd& x, bool is_stiffness) {
    const double most = x.cwiseAbs().maxCoeff();
    if (most == 0) return x;
    const double scale = size_ / most;
    return (accelerations(-scale * x, is_stiffness) - accelerations(scale * x, is_stiffness)) /
           (2 * scale);
  }

  Eigen::VectorXd accelerations(const Eigen::VectorXd& moved, bool is_stiffness) {
    std::vector<double> state = state_, rates(state_.size());
    for (std::size_t e = 0; e < gyration_.size(); ++e) {
      double* fields = &state[e * field_count];
      const auto first = Eigen::Index(6 * e);
      const Eigen::Vector3d turn = moved.segment<3>(first + 3) / gyration_[e];
      for (int axis = 0; axis < 3; ++axis) {
        fields[(is_stiffness ? ux : vx) + axis] += moved[first + axis];
        if (!is_stiffness) fields[wx + axis] += turn[axis];
      }
      if (is_stiffness) this->turn(fields, turn);
    }
    dynamics_.rates(state, signals_, rates);
    Eigen::VectorXd found(unknowns());
    for (std::size_t e = 0; e < gyration_.size(); ++e)
      for (int axis = 0; axis < 3; ++axis) {
        found[Eigen::Index(6 * e) + axis] = rates[e * field_count + std::size_t(vx + axis)];
        found[Eigen::Index(6 * e) + 3 + axis] =
            gyration_[e] * rates[e * field_count + std::size_t(wx + axis)];
      }
    return found;
  }

  void turn(double* fields, const Eigen::Vector3d& turn) const {
    const Orientation<double> q = reference::orientation_fields(fields);
    const bool are_vectors = dynamics_.coordinates().has_vectors();
    reference::set_orientation_fields(
        fields, are_vectors
                    ? Orientation<double>{0, q.v + turn}
                    : reference::product(reference::orientation_of_vector<double>(turn), q));
  }

  reference::Dynamics<double> dynamics_;
  std::vector<double> state_; ///< without velocities, in the coordinates of dynamics_
  double size_;
  std::vector<double> gyration_;
  std::vector<double> signals_;
};

/// Largest real part of an eigenvalue, by Arnoldi iteration.
template <class Product>
double largest_eigenvalue(Eigen::Index unknowns, const Product& times) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd start(unknowns);
  for (double& entry : start) entry = normal(generator);
  start = times(start).eval(); // without clamped degrees of freedom
  const double size = start.norm();
  if (!(size > 0) || !std::isfinite(size)) return 0;
  const auto products = int(std::min<Eigen::Index>(most_products, unknowns));
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(unknowns, products + 1);
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(products + 1, products);
  basis.col(0) = start / size;
  int found = 0;
  while (found < products) {
    Eigen::VectorXd next = times(basis.col(found));
    for (int n = 0; n <= found; ++n) {
      projected(n, found) = basis.col(n).dot(next);
      next -= projected(n, found) * basis.col(n);
    }
    const double rest = next.norm();
    projected(found + 1, found) = rest;
    ++found;
    if (rest <= 1e-9 * projected.cwiseAbs().maxCoeff()) break;
    basis.col(found) = next / rest;
  }
  return std::max(0.0, eigenvalues(projected.topLeftCorner(found, found)).real().maxCoeff());
}

} // namespace

double stable_step_at_state(const Problem& problem, Rotation rotation,
                            std::span<const double> state, double limit_at_rest) {
  std::vector<double> rest(state.size(), 0.0);
  StateMatrices at_rest(problem, rotation, rest), in_state(problem, rotation, state);
  const auto growth_of = [&](Eigen::VectorXd (StateMatrices::*product)(const Eigen::VectorXd&)) {
    const auto largest = [&](StateMatrices& matrices) {
      return largest_eigenvalue(matrices.unknowns(),
                                [&](const Eigen::VectorXd& x) { return (matrices.*product)(x); });
    };
    const double before = largest(at_rest);
    return before > 0 ? largest(in_state) / before : 0;
  };
  const double growth = std::max(std::sqrt(growth_of(&StateMatrices::stiffness_times)),
                                 growth_of(&StateMatrices::damping_times));
  return growth > 0 ? limit_at_rest / growth : limit_at_rest;
}

} // namespace dss
