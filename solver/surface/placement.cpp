#include "solver/surface/placement.hpp"

#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

const std::vector<std::pair<std::string, double>> length_units = {
    {"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}};
const std::vector<std::string> signed_axes = {"+x", "-x", "+y", "-y", "+z", "-z"};

} // namespace

double length_of_unit(const std::string& name) {
  for (const auto& [unit, metres] : length_units)
    if (unit == name) return metres;
  throw InputError(
      fmt::format("\"{}\" is not a unit of length; units are m, cm, mm, um, in", name));
}

void SurfacePlacement::set_axes(const std::vector<std::string>& axes) {
  std::array<bool, 3> is_taken{};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto known = std::ranges::find(signed_axes, axes[a]);
    const auto number = std::size_t(known - signed_axes.begin());
    if (axes.size() != 3 || known == signed_axes.end() || is_taken[number / 2])
      throw InputError(fmt::format("axes {}: give three different axes of the file, that become x, "
                                   "y and z, of {}",
                                   fmt::join(axes, ", "), fmt::join(signed_axes, ", ")));
    is_taken[number / 2] = true;
    axis[a] = int(number / 2);
    is_reversed[a] = number % 2 == 1;
  }
}

bool SurfacePlacement::is_mirrored() const {
  const bool is_odd = (axis[1] - axis[0] + 3) % 3 != 1;
  return is_odd != (is_reversed[0] != (is_reversed[1] != is_reversed[2]));
}

} // namespace dss
