#pragma once
/// What a method keeps in the rows of a state, and what its stages do with them.
#include "kernels/model.hpp"
#include "solver/numerics/method.hpp"
#include "variants/engine/packed_rows.hpp"

#include <cstddef>

namespace dss {

/// Which numbers of an element a row of the state holds. The rows of stages hold the same. A pack
/// holds, in this order:
/// 1. the fields of the model;
/// 2. if the method is staggered and forces depend on velocities: the velocities of the half step
/// (those among the fields are then predictions);
/// 3. in compensated precision: a low part for each field, in the order of the fields; if there are
///    half-step velocities, the low parts of the velocities are theirs;
/// 4. if elements have a pressure: its numbers, which belong to the row as the input of a stage.
/// In 3. the rows of stages hold increments instead of low parts.
struct RowStorage {
  int fields = 0, half_velocities = 0, lows = 0, pressures = 0;
  template <class T, int W>
  RowStorage(const PackedRows<T, W>& packed, const Method& method, Precision precision)
      : fields(packed.fields()),
        half_velocities(method.is_staggered() ? packed.leapfrog_fields - packed.fields() : 0),
        lows(precision == Precision::f32c ? fields : 0), pressures(packed.pressure_fields) {}

  int stored() const { return fields + half_velocities + lows + pressures; }
  int first_low() const { return fields + half_velocities; }
  bool is_predicted() const { return half_velocities > 0; }
  bool is_compensated() const { return lows > 0; }
};

/// The action of a stage with a number of increments (stages whose outputs it reads).
inline row_action action_of(const Method& method, const RowStorage& storage, std::size_t increments,
                            bool is_last) {
  const bool is_kept = storage.is_compensated();
  if (method.has_error_stage && is_last) return is_kept ? kept_error : error_stage;
  if (method.has_error_stage) is_last = false; // a tried step is not accepted yet
  if (method.is_in_place()) {
    if (storage.is_predicted()) return is_kept ? kept_predicted : predicted_step;
    return is_kept ? kept_leapfrog : leapfrog_step;
  }
  if (is_kept) return is_last ? kept_step : kept_stage;
  return increments == 0 ? plain_stage : increments <= 3 ? combined_stage : wide_stage;
}

} // namespace dss
