#include "solver/statics/held.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/linearised.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace dss {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A neighbour of an element, and its position relative to the element [m].
struct Joint {
  std::size_t element;
  Eigen::Vector3d offset;
};

std::vector<std::vector<Joint>> joints_of(const Problem& problem, const std::vector<int>& body) {
  std::vector<std::vector<Joint>> joints(body.size());
  const auto join = [&](std::size_t i, std::size_t j, int axis) {
    const auto half = [&](std::size_t e) {
      return problem.bodies[std::size_t(body[e])].edge[std::size_t(axis)] / 2;
    };
    const Eigen::Vector3d offset = Eigen::Vector3d::Unit(axis) * (half(i) + half(j));
    joints[i].push_back({j, offset});
    joints[j].push_back({i, -offset});
  };
  problem.lattice.for_each_link(join);
  for (const ExtraLink& extra : problem.extra_links) join(extra.i, extra.j, extra.axis);
  return joints;
}

/// Displacement and turn of an element in the six rigid motions about an origin. Unit of turns: 1 m
/// of displacement at an arm of `length`.
Matrix6 rigid_motions(const Eigen::Vector3d& place, double length) {
  Matrix6 motions = Matrix6::Identity();
  const Eigen::Vector3d x = place / length;
  motions.topRightCorner<3, 3>() << 0, x.z(), -x.y(), -x.z(), 0, x.x(), x.y(), -x.x(), 0;
  return motions;
}

/// Resistance of a group of linked elements against the six rigid motions, in shares of its
/// elements. A clamped degree of freedom, a tie, or a closed chain of links that does not fit
/// together resists.
class Group {
public:
  Group(const Linearised& system, std::uint8_t dofs, std::vector<Eigen::Vector3d>& place)
      : system_(system), dofs_(dofs), place_(place) {}

  void collect(std::size_t first, const std::vector<std::vector<Joint>>& joints,
               std::vector<bool>& is_taken) {
    members_ = {first};
    is_taken[first] = true;
    place_[first].setZero();
    for (std::size_t n = 0; n < members_.size(); ++n)
      for (const Joint& joint : joints[members_[n]]) {
        const Eigen::Vector3d place = place_[members_[n]] + joint.offset;
        length_ = std::max(length_, place.norm());
        if (!is_taken[joint.element]) {
          is_taken[joint.element] = true;
          place_[joint.element] = place;
          members_.push_back(joint.element);
        } else if ((place_[joint.element] - place).norm() > 1e-9 * length_) {
          misfits_.push_back(place_[joint.element] - place);
        }
      }
  }

  /// Name of a motion that nothing resists; empty if there is none.
  std::string free_motion() const {
    Matrix6 resistance = Matrix6::Zero();
    const auto resist = [&](const Eigen::Matrix<double, 1, 6>& row) {
      resistance += row.transpose() * row;
    };
    for (const std::size_t e : members_) {
      const Matrix6 motions = rigid_motions(place_[e], length_);
      for (int d = 0; d < 6; ++d)
        if ((system_.clamped[e] | ~dofs_) >> d & 1 || system_.tie_stiffness[d] > 0)
          resist(motions.row(d));
    }
    for (const Eigen::Vector3d& misfit : misfits_) {
      const Matrix6 strained =
          rigid_motions(misfit, length_) - Matrix6::Identity(); // a turn opens the chain
      for (int d = 0; d < 3; ++d) resist(strained.row(d));
    }
    const SymmetricEigen motions(resistance);
    if (motions.values[0] > 1e-12 * std::max(1.0, motions.values[5])) return {};
    Eigen::Index most = 0;
    // A turn about an axis that is not through the origin also displaces. It is reported as a turn.
    const Eigen::Matrix<double, 6, 1> free = motions.vectors.col(0);
    const bool turns = free.tail<3>().norm() > 1e-6;
    (turns ? free.tail<3>() : free.head<3>()).cwiseAbs().maxCoeff(&most);
    return fmt::format("{} {}", turns ? "turn about" : "move along", "xyz"[most]);
  }

private:
  const Linearised& system_;
  std::uint8_t dofs_;
  std::vector<Eigen::Vector3d>& place_;
  std::vector<std::size_t> members_;
  std::vector<Eigen::Vector3d> misfits_;
  double length_ = 1e-300;
};

} // namespace

std::string why_not_held(const Problem& problem, std::uint8_t dofs) {
  const Linearised system(problem);
  const auto joints = joints_of(problem, system.body);
  std::vector<bool> is_taken(system.body.size(), false);
  std::vector<Eigen::Vector3d> place(system.body.size());
  for (std::size_t e = 0; e < is_taken.size(); ++e) {
    if (is_taken[e]) continue;
    Group group(system, dofs, place);
    group.collect(e, joints, is_taken);
    if (const std::string motion = group.free_motion(); !motion.empty())
      return fmt::format(
          "body \"{}\" is free to {}; clamp it, or tie it to the frame by \"stabilization\"",
          problem.bodies[std::size_t(system.body[e])].name, motion);
  }
  return {};
}

} // namespace dss
