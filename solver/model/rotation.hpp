#pragma once
/// How orientations are described and integrated.
#include "solver/model/model.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace dss {

/// quaternion: unit quaternions, for any rotation; what every variant has. Of the variant `reference` alone:
/// tait_bryan: the paper's angles X-Y-Z, taken anew relative to the present orientation when the middle angle nears 90 degrees;
/// tait_bryan_raw: the same angles, never taken anew, to show why they must be;
/// linearised: small rotation vectors, A - I = [theta]x in the gaps of links and I elsewhere, which makes the equations linear;
/// small: such vectors, A = I + [theta]x.
enum class Rotation { quaternion, tait_bryan, tait_bryan_raw, linearised, small };

inline constexpr std::array rotations{Rotation::quaternion, Rotation::tait_bryan, Rotation::tait_bryan_raw,
                                      Rotation::linearised, Rotation::small};
constexpr std::string_view name(Rotation rotation) {
  constexpr std::array<std::string_view, 5> names{"quaternion", "tait_bryan", "tait_bryan_raw", "linearised", "small"};
  return names[std::size_t(rotation)];
}
constexpr std::optional<Rotation> find_rotation(std::string_view text) {
  for (const Rotation rotation : rotations)
    if (name(rotation) == text) return rotation;
  return std::nullopt;
}

/// Of the oracle that has the equations of a model; those of models with fewer degrees of freedom are the same where these suffice.
constexpr Rotation rotation_of(Model model) {
  if (model == Model::small) return Rotation::small;
  return is_linear(model) ? Rotation::linearised : Rotation::quaternion;
}

} // namespace dss
