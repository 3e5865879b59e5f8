#pragma once
/// Which degrees of freedom are integrated, and in which precision.
#include "solver/model/fields.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// spatial: six degrees of freedom, finite rotations. small: six, rotations as vectors, A = I + [theta]x. linear: small displacements too, so that
/// links have constant matrices. bending: deflection uz and rotations about x and y, linear. membrane: ux, uy and the rotation about z, linear. planar: the
/// same, finite. axial: ux alone.
enum class Model { spatial, small, linear, bending, membrane, planar, axial };
/// From the least work a step to the most.
inline constexpr std::array models{Model::axial,  Model::bending, Model::membrane, Model::planar,
                                   Model::linear, Model::small,   Model::spatial};
/// f32c: single precision whose state is summed with its low part kept, so that small steps do not lose what they add.
enum class Precision { f64, f32, f32c };
inline constexpr std::array precisions{Precision::f64, Precision::f32, Precision::f32c};
/// Of the numbers that forces are computed in.
constexpr bool is_single(Precision precision) { return precision != Precision::f64; }

constexpr std::string_view name(Model model) {
  constexpr std::array<std::string_view, 7> names{"spatial",  "small",  "linear", "bending",
                                                  "membrane", "planar", "axial"};
  return names[std::size_t(model)];
}
/// Rotations are vectors, and orientations outside a model's own state the quaternions of these.
constexpr bool has_rotation_vectors(Model model) {
  return model == Model::small || model == Model::linear || model == Model::bending || model == Model::membrane;
}
/// Equations of motion are linear but for loads in time.
constexpr bool is_linear(Model model) {
  return model == Model::linear || model == Model::bending || model == Model::membrane || model == Model::axial;
}
/// The degrees of freedom that a model has, as bits of Dof.
constexpr std::uint8_t degrees_of(Model model) {
  switch (model) {
  case Model::axial:
    return dof_ux;
  case Model::bending:
    return dof_uz | dof_rx | dof_ry;
  case Model::membrane:
  case Model::planar:
    return dof_ux | dof_uy | dof_rz;
  case Model::linear:
  case Model::small:
  case Model::spatial:
    break;
  }
  return dof_all;
}
/// All motion is in a plane z = const, and all rotation about its normal.
constexpr bool is_of_plane(Model model) { return model == Model::planar || model == Model::membrane; }
constexpr std::string_view name(Precision precision) {
  return precision == Precision::f64 ? "f64" : precision == Precision::f32 ? "f32" : "f32c";
}
constexpr std::optional<Model> find_model(std::string_view text) {
  for (const Model model : models)
    if (name(model) == text) return model;
  return std::nullopt;
}
inline std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const Model model : models) names.emplace_back(name(model));
  return names;
}
/// What --model and a scene's run.model take.
inline std::vector<std::string> model_names_and_auto() {
  std::vector<std::string> names = model_names();
  names.emplace_back("auto");
  return names;
}
constexpr std::optional<Precision> find_precision(std::string_view text) {
  for (const Precision precision : precisions)
    if (name(precision) == text) return precision;
  return std::nullopt;
}

} // namespace dss
