#pragma once
/// Functions of time in a scene.
#include "solver/json/object_node.hpp"
#include "solver/model/signal.hpp"

#include <string_view>

namespace dss {

/// Reads a signal: a number (constant), or one of {"constant"}, {"ramp"}, {"harmonic"}, {"table"},
/// {"series"} with an optional "offset".
/// @param unit  that a series must have; "1" of a factor, which may have none; empty: any
/// @throws InputError with file, JSON pointer and what is wrong
Signal read_signal(const Node& node, std::string_view unit = {});
/// Reads a signal that has two derivatives, of angles [rad]: a number, {"constant"}, {"rate"} or
/// {"harmonic"}; {"table"} and {"series"} are smooth splines through their points.
Signal read_smooth_signal(const Node& node);

} // namespace dss
