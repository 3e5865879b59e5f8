#pragma once
/// The fields of a run's record. One line here makes the JSON key, the column of the raw CSV, the
/// column of tables of cells, and the line of the page that explains columns.
#include "experiments/run/timed/run_result.hpp"

#include <nlohmann/json.hpp>
#include <span>

namespace dss {

/// How the values of all repetitions of a cell become one value of its table.
enum class Aggregate {
  none, ///< tables have no such column
  last, ///< value of the last repetition
  median,
  largest,
  distinct ///< all different texts, "deep or shared"
};

/// One field of a run's record.
struct RunField {
  const char* key;     ///< key in the JSON
  const char* column;  ///< column of the raw CSV; empty: only the JSON has it
  const char* unit;    ///< empty for texts, counts and ratios
  const char* meaning; ///< one line
  nlohmann::ordered_json (*value)(const RunResult& result); ///< null if the field does not apply
  Aggregate in_tables = Aggregate::none;
};

/// All fields, in the order of the JSON.
std::span<const RunField> run_fields();

} // namespace dss
