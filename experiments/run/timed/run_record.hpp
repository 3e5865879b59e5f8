#pragma once
/// Writes a run as one JSON record.
#include "experiments/run/plan/run_request.hpp"
#include "experiments/run/timed/run_result.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// The beginning of every record: the context, the scene and its overrides.
nlohmann::ordered_json record_of(const std::string& scene, const std::vector<Override>& overrides);

/// The fields of a result alone (run_fields.hpp).
nlohmann::ordered_json run_json(const RunResult& result);

/// The record of a run: the context in Google Benchmark's layout, the keys of DESIGN.md section 7,
/// and all other fields of run_fields().
nlohmann::ordered_json run_json(const RunRequest& request, const RunResult& result);

} // namespace dss
