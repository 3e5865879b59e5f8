#pragma once
/// Which degrees of freedom are integrated, and in which precision.
#include <optional>
#include <string_view>

namespace dss {

enum class Model { spatial, planar };
enum class Precision { f64, f32 };

constexpr std::string_view name(Model model) { return model == Model::spatial ? "spatial" : "planar"; }
constexpr std::string_view name(Precision precision) { return precision == Precision::f64 ? "f64" : "f32"; }
constexpr std::optional<Model> find_model(std::string_view text) {
  for (const Model model : {Model::spatial, Model::planar})
    if (name(model) == text) return model;
  return std::nullopt;
}
constexpr std::optional<Precision> find_precision(std::string_view text) {
  for (const Precision precision : {Precision::f64, Precision::f32})
    if (name(precision) == text) return precision;
  return std::nullopt;
}

} // namespace dss
