#pragma once
/// Which degrees of freedom are integrated, and in which precision.
#include <array>
#include <optional>
#include <string_view>

namespace dss {

enum class Model { spatial, planar };
/// f32c: single precision whose state is summed with its low part kept, so that small steps do not lose what they add.
enum class Precision { f64, f32, f32c };
inline constexpr std::array precisions{Precision::f64, Precision::f32, Precision::f32c};
/// Of the numbers that forces are computed in.
constexpr bool is_single(Precision precision) { return precision != Precision::f64; }

constexpr std::string_view name(Model model) { return model == Model::spatial ? "spatial" : "planar"; }
constexpr std::string_view name(Precision precision) {
  return precision == Precision::f64 ? "f64" : precision == Precision::f32 ? "f32" : "f32c";
}
constexpr std::optional<Model> find_model(std::string_view text) {
  for (const Model model : {Model::spatial, Model::planar})
    if (name(model) == text) return model;
  return std::nullopt;
}
constexpr std::optional<Precision> find_precision(std::string_view text) {
  for (const Precision precision : precisions)
    if (name(precision) == text) return precision;
  return std::nullopt;
}

} // namespace dss
