#pragma once
/// How long a step of a part takes here, without any exchange.
#include "variants/api.hpp"

namespace dss {

/// Seconds that this process computes in a step of a part, the least of a few short timings. Halo elements stay zero.
double measure_step_s(const Setup& setup, const Plugin& plugin, const Part& part, const HaloStrategy& strategy);

} // namespace dss
