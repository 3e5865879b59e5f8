#pragma once
/// What a method keeps of an element, in the order in which Executor::save gives it and Executor::restore takes it: the same for all
/// executors, so that elements can move from one to another.
#include "solver/model/fields.hpp"
#include "solver/numerics/method.hpp"

namespace dss {

/// The 13 fields as stored come first. Leapfrog adds the velocities of the half step before, v then w, which are those among the 13 fields
/// where an executor stores no others; and 1 if it is started, so that these velocities count, else 0.
inline constexpr int kept_half_velocities = field_count, kept_is_started = field_count + 6;

inline int kept_field_count(const Method& method) {
  return method.family == Method::Family::leapfrog ? kept_is_started + 1 : int(field_count);
}

/// Where the velocity of the half step before is kept of a velocity or spin component.
inline int kept_half_velocity(Field field) {
  return kept_half_velocities + (field <= vz ? int(field) - int(vx) : 3 + int(field) - int(wx));
}

} // namespace dss
