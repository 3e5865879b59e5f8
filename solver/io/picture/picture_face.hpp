#pragma once
/// A face to draw.
#include <Eigen/Core>

#include <array>

namespace dss {

/// Four corners and a value at each.
struct PictureFace {
  std::array<Eigen::Vector3f, 4> corners; ///< around it [m]
  std::array<float, 4> values{};          ///< at the corners
};

} // namespace dss
