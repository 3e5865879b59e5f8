#pragma once
/// An image of quadrilaterals, hidden ones behind others.
#include "solver/io/picture/picture_face.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace dss {

using Colour = std::array<float, 3>; ///< red, green, blue, 0 to 1

/// Colour of 0 (low) to 1 (high): viridis of matplotlib, at nine places.
Colour colour_of(double value);

/// A picture under construction. It is drawn twice as large and averaged, so that edges are smooth.
class Raster {
public:
  Raster(int width, int height);
  /// Draws a face of corners in pixels, with the depth towards the eye as the third number.
  /// @param brightness  of its colours
  /// @param colour      of an interpolated value
  template <class ColourOf>
  void draw(const PictureFace& face, float brightness, ColourOf&& colour);
  /// The image as a PNG file, without background.
  std::string png() const;

private:
  struct Pixel {
    float depth = -1e30F;
    Colour colour{};
    bool is_drawn = false;
  };
  static constexpr int samples = 2; ///< along each axis of a pixel
  template <class ColourOf>
  void draw_triangle(const std::array<Eigen::Vector3f, 3>& corners,
                     const std::array<float, 3>& values, float brightness, ColourOf&& colour);

  int width_, height_;
  std::vector<Pixel> pixels_; ///< of the large image
};

template <class ColourOf>
void Raster::draw(const PictureFace& face, float brightness, ColourOf&& colour) {
  const auto& c = face.corners;
  const auto& v = face.values;
  draw_triangle({c[0], c[1], c[2]}, {v[0], v[1], v[2]}, brightness, colour);
  draw_triangle({c[0], c[2], c[3]}, {v[0], v[2], v[3]}, brightness, colour);
}

template <class ColourOf>
void Raster::draw_triangle(const std::array<Eigen::Vector3f, 3>& corners,
                           const std::array<float, 3>& values, float brightness,
                           ColourOf&& colour) {
  std::array<Eigen::Vector3f, 3> p = corners;
  for (Eigen::Vector3f& corner : p) corner.head<2>() *= float(samples);
  const auto side = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b, float x, float y) {
    return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
  };
  const float area = side(p[0], p[1], p[2].x(), p[2].y());
  if (area == 0) return;
  const Eigen::Vector3f low = p[0].cwiseMin(p[1]).cwiseMin(p[2]),
                        high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  const int first_x = std::max(0, int(low.x())),
            last_x = std::min(samples * width_ - 1, int(high.x())),
            first_y = std::max(0, int(low.y())),
            last_y = std::min(samples * height_ - 1, int(high.y()));
  for (int y = first_y; y <= last_y; ++y)
    for (int x = first_x; x <= last_x; ++x) {
      const float at_x = float(x) + 0.5F, at_y = float(y) + 0.5F;
      const float a = side(p[1], p[2], at_x, at_y) / area, b = side(p[2], p[0], at_x, at_y) / area,
                  c = 1 - a - b;
      if (a < 0 || b < 0 || c < 0) continue;
      Pixel& pixel = pixels_[std::size_t(y) * std::size_t(samples * width_) + std::size_t(x)];
      const float depth = a * p[0].z() + b * p[1].z() + c * p[2].z();
      if (pixel.is_drawn && depth <= pixel.depth) continue;
      pixel.depth = depth;
      pixel.is_drawn = true;
      pixel.colour = colour(a * values[0] + b * values[1] + c * values[2]);
      for (float& part : pixel.colour) part *= brightness;
    }
}

} // namespace dss
