#pragma once
/// Circumstances of a measurement, in Google Benchmark's layout, and what of them the program itself sets.
#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// Date, host, CPU, caches, load, build, library versions, affinity; the content of "context".
nlohmann::ordered_json measurement_context();

/// The present time, UTC, ISO 8601.
std::string measurement_time();

/// Processors that this process may use (its affinity mask).
int usable_cores();

} // namespace dss
