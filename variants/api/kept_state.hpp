#pragma once
/// Which numbers a method keeps of an element, in the order of StateTransfer::save and
/// StateTransfer::restore. The order is the same for all executors, so that elements can move from
/// one to another.
#include "kernels/fields.hpp"
#include "kernels/model.hpp"
#include "solver/numerics/method.hpp"

namespace dss {

/// Layout of the kept numbers of one element:
/// 1. the 13 fields as stored;
/// 2. with a staggered method: the velocities v, w of the last half step (equal to those of the 13
/// fields if the executor stores no others), then 1 if the method is started, else 0; if it is 0,
/// the velocities do not count;
/// 3. with compensated precision: the low parts of the 13 fields.
inline constexpr int kept_half_velocities = field_count, kept_is_started = field_count + 6;

/// Index of the first low part.
inline int kept_first_low(const Method& method) {
  return method.is_staggered() ? kept_is_started + 1 : int(field_count);
}
/// Kept numbers of one element.
inline int kept_field_count(const Method& method, Precision precision) {
  return kept_first_low(method) + (precision == Precision::f32c ? int(field_count) : 0);
}

/// Index of the last half step's value of a velocity or spin component.
inline int kept_half_velocity(Field field) {
  return kept_half_velocities + (field <= vz ? int(field) - int(vx) : 3 + int(field) - int(wx));
}

} // namespace dss
