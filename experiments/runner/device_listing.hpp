#pragma once
/// Listings, and that of devices.
#include <nlohmann/json.hpp>

namespace dss {

/// An array of objects that all have the same keys, with texts as values.
using Listing = nlohmann::ordered_json;

/// The program's own processor, and all OpenCL devices; why there are none is a row too.
/// @param is_measured  adds the devices' memory bandwidth and peak arithmetic
Listing device_listing(bool is_measured);

} // namespace dss
