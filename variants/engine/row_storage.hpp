#pragma once
/// What a pack of a state's row holds, and so every stage's.
#include "solver/model/model.hpp"
#include "solver/numerics/method.hpp"
#include "variants/engine/packed_rows.hpp"

namespace dss {

/// The model's fields come first; then, of a staggered method whose forces depend on velocities, the velocities of the half step, while
/// those among the fields are predictions; then, in compensated precision, the low parts of all that is summed, in the order of the
/// fields: of the half-step velocities where there are such. Rows of stages hold increments in their place.
struct RowStorage {
  int fields = 0, half_velocities = 0, lows = 0;
  template <class T, int W>
  RowStorage(const PackedRows<T, W>& packed, const Method& method, Precision precision)
      : fields(packed.fields()), half_velocities(method.is_staggered() ? packed.leapfrog_fields - packed.fields() : 0),
        lows(precision == Precision::f32c ? fields : 0) {}

  int stored() const { return fields + half_velocities + lows; }
  int first_low() const { return fields + half_velocities; }
  bool is_predicted() const { return half_velocities > 0; }
  bool is_compensated() const { return lows > 0; }
};

} // namespace dss
