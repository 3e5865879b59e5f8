#pragma once
/// Model: which degrees of freedom are integrated. Precision: in which numbers.
#include "kernels/fields.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// spatial: six degrees of freedom, finite rotations (unit quaternions).
/// small: six, rotation vectors, A = I + [theta]x.
/// linear: six, small displacements too, so a link has constant matrices.
/// bending: uz and the rotations about x and y, linear.
/// membrane: ux, uy and the rotation about z, linear.
/// planar: ux, uy and the rotation about z, finite rotations.
/// axial: ux alone.
enum class Model { spatial, small, linear, bending, membrane, planar, axial };
/// Sorted by work per step, the cheapest first.
inline constexpr std::array models{Model::axial,  Model::bending, Model::membrane, Model::planar,
                                   Model::linear, Model::small,   Model::spatial};
/// f32c: single precision with compensated sums. The low part of the state is kept, so that small
/// increments are not lost.
enum class Precision { f64, f32, f32c };
inline constexpr std::array precisions{Precision::f64, Precision::f32, Precision::f32c};
/// True if forces are computed in single precision.
constexpr bool is_single(Precision precision) { return precision != Precision::f64; }

/// Name of a model, as in scenes and on the command line.
constexpr std::string_view name(Model model) {
  constexpr std::array<std::string_view, 7> names{"spatial",  "small",  "linear", "bending",
                                                  "membrane", "planar", "axial"};
  return names[std::size_t(model)];
}
/// True if the state holds rotation vectors. Other parts of the program see the quaternions of
/// these vectors.
constexpr bool has_rotation_vectors(Model model) {
  return model == Model::small || model == Model::linear || model == Model::bending ||
         model == Model::membrane;
}
/// True if the equations of motion are linear in the state (loads may vary in time).
constexpr bool is_linear(Model model) {
  return model == Model::linear || model == Model::bending || model == Model::membrane ||
         model == Model::axial;
}
/// Degrees of freedom of a model, as bits of Dof.
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
/// True if all motion lies in a plane z = const and all rotation is about z.
constexpr bool is_of_plane(Model model) {
  return model == Model::planar || model == Model::membrane;
}
/// Name of a precision, as on the command line.
constexpr std::string_view name(Precision precision) {
  return precision == Precision::f64 ? "f64" : precision == Precision::f32 ? "f32" : "f32c";
}
/// The model or precision with a given name; nothing if there is none.
constexpr std::optional<Model> find_model(std::string_view text) {
  for (const Model model : models)
    if (name(model) == text) return model;
  return std::nullopt;
}
/// Names of all models, the cheapest first.
inline std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const Model model : models) names.emplace_back(name(model));
  return names;
}
/// Values that --model and a scene's run.model accept.
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
