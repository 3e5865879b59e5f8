#pragma once
/// Seconds a step of each halo strategy: a few steps of all parts replayed on clocks, by a latency-bandwidth model of messages (LogGP:
/// Alexandrov et al., 1995). Redundant rows are in the parts' times.
#include "variants/halo.hpp"
#include "variants/part_cost.hpp"

namespace dss {

inline constexpr double eager_bytes =
    65536; ///< messages below are copied by the processor, and need no receiver to leave

/// Strategies whose predicted step is up to so many times the least may be the fastest: what the model leaves out (receivers that share
/// an adapter among senders, ranks that are out of step) has cost up to 1.8 times.
inline constexpr double worth_trying = 2;

/// What a part does from one exchange to the next, in the order of variants/engine (staged.hpp, row_executor.cpp).
/// @param exchanges  a step  @param number  of the exchange, from 0  @param compute  called with seconds
template <class Compute>
void run_to_next_exchange(const HaloStrategy& strategy, const PartTimes& times, int exchanges, Halo& halo, int number,
                          bool is_last, Compute&& compute) {
  const int copy = number % 2, next_copy = 1 - copy;
  if (strategy.is_overlapped && !strategy.is_every_stage)
    return overlapped_step(
        halo, copy, next_copy, is_last, times.upper_s > 0, [&] { compute(times.upper_s); },
        [&](auto&& edge_is_done) {
          compute(times.edge_s);
          edge_is_done();
          compute(times.compute_s - times.upper_s - times.edge_s);
        });
  const double inner_s = strategy.is_overlapped ? times.inner_s / exchanges : 0;
  compute(inner_s);
  for (const Side side : all_sides) halo.receive(side, copy);
  compute(times.compute_s / exchanges - inner_s);
  if (is_last) return;
  for (const Side side : all_sides) halo.send(side, next_copy);
}

/// Of all parts, once they have fallen into step with one another.
double predicted_step_s(const PlannedStrategy& planned, const Network& network);

} // namespace dss
