#include "solver/io/picture/picture.hpp"

#include "solver/io/base64.hpp"
#include "solver/io/picture/raster.hpp"
#include "solver/io/xml_text.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

constexpr int picture_width = 1000, picture_height = 750;
constexpr int top = 60, margin = 30, scale_width = 150; // space for words

/// The axes of the picture: right, up, and towards the eye.
Eigen::Matrix3f view_axes() {
  const Eigen::Vector3f eye = Eigen::Vector3f(0.75F, -1.3F, 0.8F).normalized();
  const Eigen::Vector3f right = Eigen::Vector3f::UnitZ().cross(eye).normalized();
  Eigen::Matrix3f axes;
  axes << right, eye.cross(right), eye;
  return axes.transpose();
}

/// Turns faces to the view, and fits them into the picture.
void fit(std::vector<PictureFace>& faces, bool has_scale) {
  const Eigen::Matrix3f axes = view_axes();
  Eigen::AlignedBox3f box;
  for (PictureFace& face : faces)
    for (Eigen::Vector3f& corner : face.corners) {
      corner = axes * corner;
      box.extend(corner);
    }
  const float right = float(picture_width - margin - (has_scale ? scale_width : 0));
  const float scale =
      std::min((right - margin) / std::max(1e-30F, box.sizes().x()),
               float(picture_height - top - margin) / std::max(1e-30F, box.sizes().y()));
  const Eigen::Vector3f centre = box.center();
  for (PictureFace& face : faces)
    for (Eigen::Vector3f& corner : face.corners) {
      corner = scale * (corner - centre);
      corner.x() += (margin + right) / 2;
      corner.y() = float(top + picture_height - margin) / 2 - corner.y();
    }
}

/// How bright a face looks that a light from behind the eye's left shoulder meets.
float brightness_of(const PictureFace& face) {
  const auto& c = face.corners;
  Eigen::Vector3f normal = (c[2] - c[0]).cross(c[3] - c[1]).normalized();
  if (normal.z() < 0) normal = -normal;
  const Eigen::Vector3f light = Eigen::Vector3f(-0.35F, -0.55F, 0.75F).normalized();
  return 0.55F + 0.45F * std::max(0.0F, normal.dot(light));
}

std::string drawn(std::vector<PictureFace> faces, const PictureWords& words) {
  Raster raster(picture_width, picture_height);
  fit(faces, words.scale.has_value());
  const auto of_scale = [&](float value) {
    const ColourScale& scale = *words.scale;
    return colour_of((double(value) - scale.low) / std::max(1e-300, scale.high - scale.low));
  };
  const auto of_kind = [](float value) {
    static constexpr std::array<Colour, 6> kinds = {{{0.55F, 0.63F, 0.72F},
                                                     {0.87F, 0.56F, 0.34F},
                                                     {0.47F, 0.68F, 0.45F},
                                                     {0.80F, 0.45F, 0.50F},
                                                     {0.60F, 0.52F, 0.72F},
                                                     {0.78F, 0.70F, 0.38F}}};
    return kinds[std::size_t(std::lround(value)) % kinds.size()];
  };
  for (const PictureFace& face : faces) {
    const float brightness = brightness_of(face);
    if (words.scale)
      raster.draw(face, brightness, of_scale);
    else
      raster.draw(face, brightness, of_kind);
  }
  return raster.png();
}

std::string scale_svg(const ColourScale& scale) {
  constexpr int x = picture_width - scale_width, high = 140, length = 460, bars = 64;
  std::string svg;
  for (int n = 0; n < bars; ++n) {
    const Colour c = colour_of(1 - (n + 0.5) / bars);
    svg += fmt::format("<rect x=\"{}\" y=\"{:.2f}\" width=\"22\" height=\"{:.2f}\" "
                       "fill=\"rgb({:.0f},{:.0f},{:.0f})\"/>\n",
                       x, high + double(length) * n / bars,
                       double(length) / bars + (n + 1 < bars ? 0.8 : 0), 255 * c[0], 255 * c[1],
                       255 * c[2]);
  }
  constexpr int ticks = 5;
  for (int n = 0; n <= ticks; ++n)
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\">{:.3g}</text>\n", x + 30,
                       high + 6 + double(length) * n / ticks,
                       scale.high - (scale.high - scale.low) * n / ticks);
  return svg + fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n",
                           picture_width - 20, high - 22, xml_text(scale.label));
}

} // namespace

std::vector<OuterFace> outer_faces(const Lattice& lattice) {
  std::vector<std::uint8_t> is_joined(lattice.element_count); // bits by face
  lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    is_joined[i] |= std::uint8_t(2U << (2 * axis));
    is_joined[j] |= std::uint8_t(1U << (2 * axis));
  });
  std::vector<OuterFace> faces;
  for (std::size_t e = 0; e < is_joined.size(); ++e)
    for (int face = 0; face < 6; ++face) {
      if ((is_joined[e] >> face & 1) != 0) continue;
      const auto a = std::size_t(face) / 2, b = (a + 1) % 3, c = (a + 2) % 3;
      const std::size_t base = std::size_t(face % 2) << a, along = std::size_t(1) << b,
                        across = std::size_t(1) << c;
      faces.push_back({e, face, {base, base | along, base | along | across, base | across}});
    }
  return faces;
}

std::string picture_svg(const std::vector<PictureFace>& faces, const PictureWords& words) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" font-family=\"sans-serif\" font-size=\"16\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<image width=\"{0}\" height=\"{1}\" href=\"data:image/png;base64,{2}\"/>\n"
      "<text x=\"{3}\" y=\"38\" font-size=\"20\">{4}</text>\n",
      picture_width, picture_height, base64(drawn(faces, words)), margin, xml_text(words.title));
  if (words.scale) svg += scale_svg(*words.scale);
  return svg + "</svg>\n";
}

} // namespace dss
