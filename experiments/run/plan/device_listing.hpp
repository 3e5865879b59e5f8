#pragma once
/// Lists the devices of this machine.
#include <nlohmann/json.hpp>

namespace dss {

/// An array of objects with the same keys. All values are texts.
using Listing = nlohmann::ordered_json;

/// Lists this machine's processor and all OpenCL devices. If there are none, a row says why.
/// @param is_measured  true: also measures each device's memory bandwidth and peak arithmetic
Listing device_listing(bool is_measured);

} // namespace dss
