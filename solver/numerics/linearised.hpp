#pragma once
/// A problem linearised at rest: M x'' + C x' + K x = 0 with six degrees of freedom an element,
/// stored as links. spectrum.hpp and modes.hpp compute its eigenvalues. Gyroscopic terms vanish at
/// rest.
#include "solver/model/problem.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dss {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Stiffness [N/m, N, N m] and damping of a link at rest, in the order (u_i, theta_i, u_j,
/// theta_j).
struct LinkMatrices {
  Matrix12 k, c;
  double least_damping = 0; ///< largest b [s] for which c - b k_bound has no negative eigenvalue
  /// Not less than k with the shares of its elements' pressures: (sum of n terms)^2 is at most n
  /// times the sum of their squares, and an element has at most six links.
  Matrix12 k_bound;
};

/// What the pressure of an element adds to the energy of a system of more than two elements:
/// 1/2 weight (sum of coefficient x_dof)^2, a dof being 6 element + 0 .. 5.
struct PressureTerm {
  struct Part {
    std::size_t dof;
    double coefficient;
  };
  double weight;
  std::vector<Part> parts; ///< ascending by dof
};

/// Kinds of links with their matrices, ties to the frame, and the inverse inertia of elements.
/// free_inverse_inertia has zeros for clamped degrees of freedom.
struct Linearised {
  struct Link {
    std::size_t i, j, kind;
  };
  std::vector<LinkMatrices> kinds;
  std::vector<Link> links;
  std::vector<PressureTerm> pressures;
  std::vector<int> body;                ///< of each element
  std::vector<std::uint8_t> clamped;    ///< bits of Dof of each element
  std::vector<Vector6> inverse_inertia; ///< of each body [1/kg, 1/(kg m^2)]
  std::vector<double> mass_ratio;       ///< of each element (Problem::mass_ratio); empty: all 1
  Vector6 tie_stiffness, tie_damping;   ///< of the stabilization, for every element

  explicit Linearised(const Problem& problem);
  Vector6 free_inverse_inertia(std::size_t element) const;
};

} // namespace dss
