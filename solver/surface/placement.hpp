#pragma once
/// How the numbers of a file become places of a scene.
#include <array>
#include <string>
#include <vector>

namespace dss {

/// Length of a unit [m]: "m", "cm", "mm", "um" or "in".
/// @throws InputError that lists them
double length_of_unit(const std::string& name);

/// Where a file's places are in a scene.
struct SurfacePlacement {
  double unit = 1; ///< length of 1 in the file [m]
  /// Axis of the file that becomes x, y and z: 0, 1, 2; and whether its sign changes.
  std::array<int, 3> axis{0, 1, 2};
  std::array<bool, 3> is_reversed{};

  /// @param axes  of the file, that become x, y and z: such as {"+y", "+z", "+x"}
  /// @throws InputError unless they are three different axes
  void set_axes(const std::vector<std::string>& axes);
  /// True if the axes are those of a left hand: then triangles would show their inner sides.
  bool is_mirrored() const;
};

} // namespace dss
