#pragma once
/// Circumstances of a measurement, in the JSON layout of Google Benchmark. The program's own
/// settings are included.
#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// The value of "context": date, host, CPU, caches, load, build, library versions, affinity.
nlohmann::ordered_json measurement_context();

/// The present time in UTC, as ISO 8601.
std::string measurement_time();

} // namespace dss
