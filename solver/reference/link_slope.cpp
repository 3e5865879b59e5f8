#include "solver/reference/link_slope.hpp"

#include "solver/reference/laws.hpp"

#include <unsupported/Eigen/AutoDiff>

namespace dss::reference {
namespace {

using Derivatives = Eigen::Matrix<double, 12, 1>;
using Slope = Eigen::AutoDiffScalar<Derivatives>;

/// A number with derivatives by three successive variables.
Slope varied(double value, int first, const Eigen::RowVector3d& derivatives) {
  Slope slope(value);
  slope.derivatives().setZero();
  slope.derivatives().segment<3>(first) = derivatives;
  return slope;
}

/// A vector whose derivative by three successive variables is a matrix.
Vector<Slope> varied(const Vector<double>& values, int first, const Matrix<double>& derivatives) {
  Vector<Slope> vector;
  for (Eigen::Index n = 0; n < 3; ++n) vector[n] = varied(values[n], first, derivatives.row(n));
  return vector;
}

/// @param first  of the element's six variables
Motion<Slope> varied(const Motion<double>& at, Rotation rotation, int first,
                     const Variation& variation) {
  const Matrix<double> identity = Matrix<double>::Identity();
  const int turns = first + 3;
  Motion<Slope> motion;
  motion.u = varied(at.u, first, variation.moved * identity);
  motion.v = varied(at.v, first, variation.sped * identity);
  motion.w = varied(at.w, turns, variation.sped * identity);
  const bool is_vector = has_vectors(rotation);
  // A turn d about axes in space changes A by [d]x A = -([A's columns]x d), and q by 1/2 (0, d) q.
  // Rotation vectors change by d, and q is half of them.
  const Matrix<double> moving = is_vector ? identity : at.rotation();
  for (Eigen::Index c = 0; c < 3; ++c)
    motion.turned.col(c) =
        varied(Vector<double>(at.turned.col(c)), turns,
               -variation.moved * cross_matrix<double>(Vector<double>(moving.col(c))));
  const double half = variation.moved / 2, q0 = is_vector ? 1 : at.q.q0();
  const Vector<double> v = is_vector ? Vector<double>::Zero() : at.q.v;
  motion.q.s = varied(at.q.s, turns, -half * v.transpose());
  motion.q.v = varied(at.q.v, turns, half * (q0 * identity - cross_matrix<double>(v)));
  return motion;
}

/// The link's motions as functions of the twelve variables.
struct VariedLink {
  VariedLink(const MovingLink& link, const Variation& variation)
      : i(varied(link.i, link.rotation, 0, variation)),
        j(varied(link.j, link.rotation, 6, variation)), properties(cast<Slope>(link.properties)) {}
  Motion<Slope> i, j;
  LinkProperties<Slope> properties;
};

} // namespace

Eigen::Matrix<double, 12, 12> reaction_slope(const MovingLink& link,
                                             const LinkPressure<double>* pressure,
                                             const Variation& variation) {
  const VariedLink at(link, variation);
  Reaction<Slope> reaction = reaction_by(link.rotation, at.i, at.j, at.properties);
  if (pressure != nullptr) {
    const auto held = cast<Slope>(*pressure);
    const Reaction<Slope> more =
        pressure_reaction_by(link.rotation, at.i, at.j, at.properties, held);
    reaction.force += more.force;
    reaction.moment_i += more.moment_i;
    reaction.moment_j += more.moment_j;
  }
  Eigen::Matrix<double, 12, 12> slope;
  for (Eigen::Index n = 0; n < 3; ++n) {
    slope.row(n) = reaction.force[n].derivatives();
    slope.row(n + 3) = reaction.moment_i[n].derivatives();
    slope.row(n + 6) = -reaction.force[n].derivatives();
    slope.row(n + 9) = reaction.moment_j[n].derivatives();
  }
  return slope;
}

Eigen::Matrix<double, 4, 12> strain_slope(const MovingLink& link, const Variation& variation) {
  const VariedLink at(link, variation);
  ElementStrain<Slope> strain;
  add_link(link.properties.axis, strain_by(link.rotation, at.i, at.j, at.properties), strain);
  Eigen::Matrix<double, 4, 12> slope;
  slope.row(0) = strain.volume.derivatives();
  for (Eigen::Index n = 0; n < 3; ++n) slope.row(n + 1) = strain.curvature[n].derivatives();
  return slope;
}

} // namespace dss::reference
