#pragma once
/// What a part computes and exchanges, as JSON. Ranks send it to each other, and the program to
/// simulated ranks.
#include "variants/cost/part_cost.hpp"

#include <nlohmann/json.hpp>

namespace dss {

NLOHMANN_JSON_SERIALIZE_ENUM(Side, {{Side::lower, "lower"},
                                    {Side::upper, "upper"},
                                    {Side::among, "among"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart::Face, part, side, send_bytes, receive_bytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PartTimes, compute_s, inner_s, upper_s, edge_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart, times, faces)

} // namespace dss
