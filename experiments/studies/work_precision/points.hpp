#pragma once
/// Points of a work-precision table: which belong together, and the best of them.
#include "experiments/base/records.hpp"

#include <string>

namespace dss {

/// Points with the same one are compared.
inline std::string problem_of(const Record& row) {
  return text_in(row, "scene") + " " + text_in(row, "set") + " " + text_in(row, "end_time_s");
}

/// Measured, and of use.
inline bool is_comparable(const Record& row) {
  return text_in(row, "status") == "ok" && !text_in(row, "measured_wall_s").empty();
}

/// The comparable row of the least value in a column among those that a condition takes; null if
/// there is none.
template <class Condition>
const Record* least(const Table& points, const char* column, const Condition& takes) {
  const Record* best = nullptr;
  for (const Record& row : points.rows)
    if (is_comparable(row) && takes(row) &&
        (best == nullptr || number_in(row, column) < number_in(*best, column)))
      best = &row;
  return best;
}

} // namespace dss
