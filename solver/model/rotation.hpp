#pragma once
/// How orientations are described and integrated.
#include "kernels/model.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace dss {

/// quaternion: unit quaternions, for any rotation. Every variant has them. Only the variant
/// `reference` has the others:
/// tait_bryan: the paper's angles X-Y-Z. They restart from the present orientation when the middle
/// angle nears 90 degrees.
/// tait_bryan_every_step: the same angles, restarted after every step, as the paper does it. The
/// variant `as_published` computes with them.
/// tait_bryan_raw: the same angles without restart, to show why the restart is needed.
/// linearised: small rotation vectors, A - I = [theta]x in the gaps of links and A = I elsewhere,
/// so the equations are linear.
/// small: small rotation vectors, A = I + [theta]x everywhere.
enum class Rotation {
  quaternion,
  tait_bryan,
  tait_bryan_every_step,
  tait_bryan_raw,
  linearised,
  small
};

inline constexpr std::array rotations{
    Rotation::quaternion,     Rotation::tait_bryan, Rotation::tait_bryan_every_step,
    Rotation::tait_bryan_raw, Rotation::linearised, Rotation::small};
/// Name of a rotation, as in --rotation.
constexpr std::string_view name(Rotation rotation) {
  constexpr std::array<std::string_view, rotations.size()> names{
      "quaternion", "tait_bryan", "tait_bryan_every_step", "tait_bryan_raw", "linearised", "small"};
  return names[std::size_t(rotation)];
}
/// The rotation with a given name; nothing if there is none.
constexpr std::optional<Rotation> find_rotation(std::string_view text) {
  for (const Rotation rotation : rotations)
    if (name(rotation) == text) return rotation;
  return std::nullopt;
}

/// True if orientations are vectors from the rest orientation that add up.
constexpr bool has_vectors(Rotation rotation) {
  return rotation == Rotation::linearised || rotation == Rotation::small;
}

/// The description whose oracle has the equations of a model. A model with fewer degrees of freedom
/// has the same equations where its degrees of freedom suffice.
constexpr Rotation rotation_of(Model model) {
  if (model == Model::small) return Rotation::small;
  return is_linear(model) ? Rotation::linearised : Rotation::quaternion;
}

} // namespace dss
