#pragma once
/// The terms of the equations as compile-time switches.
namespace dss {

/// Compile-time switches. A term that is absent is not compiled in (DESIGN.md section 2).
struct Terms {
  bool is_material = false; ///< material link law, else the paper's law
  bool is_damped = false;   ///< link terms that depend on velocities
  /// Rotational stiffness in the paper's law; the material law always has it.
  bool is_bending = false;
  bool is_gyroscopic = false; ///< inertia is a tensor
  bool is_tied = false;       ///< stabilization
  /// Edges of an element differ. Used by the paper's law: equal edges share their constants.
  bool is_oblong = false;
  /// Gaps across a link have two constants of shear. Used by the material law.
  bool has_two_shears = false;
  /// Elements have a pressure. With two shears also moments, because only bodies with elements that
  /// are one layer thick have either.
  bool has_pressure = false;
  constexpr bool has_couples() const { return is_material || is_damped || is_bending; }
  /// True if forces depend on velocities. The leapfrog method then carries predicted velocities.
  constexpr bool is_velocity_dependent() const { return is_damped || is_gyroscopic || is_tied; }
  /// True for rows with the terms that few scenes have.
  constexpr bool is_full() const { return is_gyroscopic && is_tied; }
  constexpr bool operator==(const Terms&) const = default;
  constexpr bool covers(const Terms& need) const {
    return is_material == need.is_material && is_damped >= need.is_damped &&
           (is_material || is_bending >= need.is_bending) && is_gyroscopic >= need.is_gyroscopic &&
           is_tied >= need.is_tied && (is_material || is_oblong >= need.is_oblong) &&
           has_two_shears >= need.has_two_shears && has_pressure == need.has_pressure;
  }
};

} // namespace dss
