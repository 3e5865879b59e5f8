#include "solver/surface/winding_number.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace dss {
namespace {

constexpr std::uint32_t leaf_size = 8;
/// A cluster counts as a dipole from this many of its radii on.
constexpr double dipole_radii = 2.5;

} // namespace

WindingNumber::WindingNumber(const Surface& surface)
    : surface_(surface), order_(surface.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  make_cluster(0, std::uint32_t(order_.size()));
}

std::uint32_t WindingNumber::make_cluster(std::uint32_t first, std::uint32_t count) {
  const auto number = std::uint32_t(clusters_.size());
  Cluster own;
  own.first = first, own.count = count;
  own.centre = own.area = Eigen::Vector3d::Zero();
  double weight = 0;
  Eigen::AlignedBox3d box;
  const auto middle_of = [&](std::uint32_t t) {
    const auto [a, b, c] = surface_.corners_of(t);
    return Eigen::Vector3d((a + b + c) / 3);
  };
  for (std::uint32_t n = first; n < first + count; ++n) {
    const Eigen::Vector3d area = surface_.area_of(order_[n]), middle = middle_of(order_[n]);
    own.area += area;
    own.centre += area.norm() * middle;
    weight += area.norm();
    box.extend(middle);
  }
  own.centre = weight > 0 ? Eigen::Vector3d(own.centre / weight) : box.center();
  for (std::uint32_t n = first; n < first + count; ++n)
    for (const Eigen::Vector3d& corner : surface_.corners_of(order_[n]))
      own.radius = std::max(own.radius, (corner - own.centre).norm());
  clusters_.push_back(own);
  if (count <= leaf_size) return number;
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return middle_of(a)[axis] < middle_of(b)[axis];
  });
  make_cluster(first, half);
  const std::uint32_t second = make_cluster(first + half, count - half);
  clusters_[number].second = second;
  return number;
}

double WindingNumber::of_triangle(std::uint32_t triangle, const Eigen::Vector3d& point) const {
  // Solid angle of a triangle: van Oosterom, Strackee, 1983.
  auto [a, b, c] = surface_.corners_of(triangle);
  a -= point, b -= point, c -= point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double WindingNumber::at(const Eigen::Vector3d& point) const {
  double angle = 0;
  std::array<std::uint32_t, 64> waiting{}; // the tree is balanced, so it is less deep
  std::size_t depth = 1;
  while (depth > 0) {
    const std::uint32_t number = waiting[--depth];
    const Cluster& cluster = clusters_[number];
    const Eigen::Vector3d reach = cluster.centre - point;
    const double distance = reach.norm();
    if (distance > dipole_radii * cluster.radius) {
      angle += cluster.area.dot(reach) / (distance * distance * distance);
    } else if (cluster.second == 0) {
      for (std::uint32_t n = cluster.first; n < cluster.first + cluster.count; ++n)
        angle += of_triangle(order_[n], point);
    } else {
      waiting[depth++] = number + 1;
      waiting[depth++] = cluster.second;
    }
  }
  return angle / (4 * std::numbers::pi);
}

} // namespace dss
