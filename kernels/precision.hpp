#pragma once
/// In which numbers a run computes.
#include <array>
#include <optional>
#include <string_view>

namespace dss {

/// f32c: single precision with compensated sums. The low part of the state is kept, so that small
/// increments are not lost.
enum class Precision { f64, f32, f32c };
inline constexpr std::array precisions{Precision::f64, Precision::f32, Precision::f32c};
/// True if forces are computed in single precision.
constexpr bool is_single(Precision precision) { return precision != Precision::f64; }
/// Name of a precision, as on the command line.
constexpr std::string_view name(Precision precision) {
  return precision == Precision::f64 ? "f64" : precision == Precision::f32 ? "f32" : "f32c";
}
/// The precision with a given name; nothing if there is none.
constexpr std::optional<Precision> find_precision(std::string_view text) {
  for (const Precision precision : precisions)
    if (name(precision) == text) return precision;
  return std::nullopt;
}

} // namespace dss
