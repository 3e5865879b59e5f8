#pragma once
/// What devices and hybrids cost and gain: transfers and launches, shares of the members and of the
/// device's ceilings.
#include "experiments/measure/study_samples.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

const std::vector<std::string>& device_columns();
/// Fills device_columns() of a cell on a device or of a hybrid; empty for what is not comparable
/// (see StudySamples::speedup).
void put_devices(const CellStudy& study, const StudySamples& samples, const Cell& cell,
                 Record& row);

/// Bytes an element of the state: what a step must read once and write once.
double state_bytes(const std::string& model, const std::string& precision);

} // namespace dss
