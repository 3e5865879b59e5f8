#pragma once
/// Winding numbers of surfaces that may be open.
#include "solver/surface/surface.hpp"

#include <cstdint>
#include <vector>

namespace dss {

/// The generalised winding number of a point: the solid angle of all triangles over 4 pi, 1 inside
/// of a closed surface and 0 outside, smooth across holes (Jacobson, Kavan, Sorkine-Hornung, 2013).
/// Far triangles count together as one dipole in their centre (Barill et al., 2018), with an error
/// of some 1e-2. Debian has no library with it.
class WindingNumber {
public:
  explicit WindingNumber(const Surface& surface);
  double at(const Eigen::Vector3d& point) const;

private:
  /// Triangles [first, first + count) of order_. Its children, if any, follow it and stand at
  /// `second`.
  struct Cluster {
    Eigen::Vector3d centre, area; ///< mean place weighted by area; sum of the areas
    double radius = 0;            ///< of the sphere about the centre that holds all triangles
    std::uint32_t first = 0, count = 0;
    std::uint32_t second = 0; ///< 0: no children
  };
  std::uint32_t make_cluster(std::uint32_t first, std::uint32_t count);
  double of_triangle(std::uint32_t triangle, const Eigen::Vector3d& point) const;

  const Surface& surface_;
  std::vector<std::uint32_t> order_;
  std::vector<Cluster> clusters_;
};

} // namespace dss
