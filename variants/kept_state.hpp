#pragma once
/// What a method keeps of an element, in the order in which Executor::save gives it and Executor::restore takes it: the same for all
/// executors, so that elements can move from one to another.
#include "solver/model/fields.hpp"
#include "solver/model/model.hpp"
#include "solver/numerics/method.hpp"

namespace dss {

/// The 13 fields as stored come first. Staggered methods add the velocities of the half step before, v then w, which are those among the
/// 13 fields where an executor stores no others; and 1 if they are started, so that these velocities count, else 0. Compensated precision
/// adds the low parts of the 13 fields.
inline constexpr int kept_half_velocities = field_count, kept_is_started = field_count + 6;

inline int kept_first_low(const Method& method) {
  return method.is_staggered() ? kept_is_started + 1 : int(field_count);
}
inline int kept_field_count(const Method& method, Precision precision) {
  return kept_first_low(method) + (precision == Precision::f32c ? int(field_count) : 0);
}

/// Where the velocity of the half step before is kept of a velocity or spin component.
inline int kept_half_velocity(Field field) {
  return kept_half_velocities + (field <= vz ? int(field) - int(vx) : 3 + int(field) - int(wx));
}

} // namespace dss
