#include "solver/io/picture/raster.hpp"

#include "solver/error.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>

namespace dss {

Colour colour_of(double value) {
  constexpr std::array<Colour, 9> places = {{{0.267F, 0.005F, 0.329F},
                                             {0.279F, 0.175F, 0.483F},
                                             {0.230F, 0.322F, 0.546F},
                                             {0.173F, 0.449F, 0.558F},
                                             {0.128F, 0.567F, 0.551F},
                                             {0.158F, 0.684F, 0.502F},
                                             {0.370F, 0.789F, 0.383F},
                                             {0.678F, 0.864F, 0.190F},
                                             {0.993F, 0.906F, 0.144F}}};
  const double at = std::clamp(value, 0.0, 1.0) * double(places.size() - 1);
  const std::size_t lower = std::min(std::size_t(at), places.size() - 2);
  const auto part = float(at - double(lower));
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = (1 - part) * places[lower][c] + part * places[lower + 1][c];
  return colour;
}

Raster::Raster(int width, int height)
    : width_(width), height_(height),
      pixels_(std::size_t(samples * width) * std::size_t(samples * height)) {}

std::string Raster::png() const {
  std::vector<std::uint8_t> bytes; // red, green, blue, opacity
  bytes.reserve(4 * std::size_t(width_) * std::size_t(height_));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      Colour sum{};
      int drawn = 0;
      for (int sub = 0; sub < samples * samples; ++sub) {
        const int at_y = samples * y + sub / samples, at_x = samples * x + sub % samples;
        const Pixel& pixel =
            pixels_[std::size_t(at_y) * std::size_t(samples * width_) + std::size_t(at_x)];
        if (!pixel.is_drawn) continue;
        ++drawn;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += pixel.colour[c];
      }
      for (const float part : sum)
        bytes.push_back(std::uint8_t(std::lround(255 * part / float(std::max(1, drawn)))));
      bytes.push_back(std::uint8_t(255 * drawn / (samples * samples)));
    }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(width_), image.height = png_uint_32(height_);
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  std::string file;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, bytes.data(), 0, nullptr) != 0) {
    file.resize(size);
    if (png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr) != 0)
      return file;
  }
  throw std::runtime_error(std::string("raster.cpp: libpng: ") + image.message);
}

} // namespace dss
