#pragma once
/// Pictures of bodies: their outer faces, seen from one side.
#include "solver/io/picture/picture_face.hpp"
#include "solver/lattice/lattice.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A face of an element without neighbour behind it.
struct OuterFace {
  std::size_t element = 0;
  int face = 0; ///< 2 axis, + 1 if an upper one
  /// Its corners, around it: bit a is set if the corner is an upper one along axis a.
  std::array<std::size_t, 4> corners{};
};
std::vector<OuterFace> outer_faces(const Lattice& lattice);

/// Values and colours.
struct ColourScale {
  std::string label; ///< such as "von Mises stress [MPa]"
  double low = 0, high = 1;
};

/// What a picture shows.
struct PictureWords {
  std::string title;
  std::optional<ColourScale> scale; ///< none: values are whole numbers, of a few colours
};

/// Draws faces as an SVG of text with the raster inside, 1000 x 750 pixels. The view is from the
/// front, the right and above; it has no perspective.
std::string picture_svg(const std::vector<PictureFace>& faces, const PictureWords& words);

} // namespace dss
