#pragma once
/// Seconds a step of each halo strategy by a latency-bandwidth model; redundant rows are in the compute time.
#include "variants/distribution.hpp"

namespace dss {

inline constexpr double eager_bytes = 65536; ///< largest message that the processor copies

/// One rank's step under a strategy.
struct HaloCost {
  double compute_s = 0; ///< of a step, halo elements that are computed again among it
  double hiding_s = 0;  ///< part of it during which messages are under way
  int exchanges = 1;    ///< a step: its stages, or one
  int faces = 0;        ///< neighbours
  double bytes = 0;     ///< sent to all neighbours in one exchange
};

/// Messages in rounds one after the other (sendrecv), or all at once; what is not hidden behind computation adds to it.
double predicted_step_s(const HaloStrategy& strategy, const HaloCost& cost, const Network& network);

} // namespace dss
