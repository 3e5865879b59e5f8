#pragma once
/// Predicted time of a step for each halo strategy. A few steps of all parts are replayed on
/// clocks, with a latency-bandwidth model of messages (LogGP: Alexandrov et al., 1995). The parts'
/// times include the rows that are computed redundantly.
#include "variants/api/halo.hpp"
#include "variants/cost/part_cost.hpp"

namespace dss {

/// The processor copies messages below this size [bytes], and such messages leave before the
/// receiver is ready.
inline constexpr double eager_bytes = 65536;

/// auto tries every strategy whose predicted step is up to this many times the shortest predicted
/// one. The margin covers what the model leaves out: receivers that share an adapter among senders,
/// and ranks that drift apart (variants/mpi/README.md, Strategies).
inline constexpr double worth_trying = 2;

/// Work of a part from one exchange to the next, in the order of variants/engine (staged.hpp,
/// row_executor.cpp).
/// @param exchanges  exchanges in a step
/// @param number     number of this exchange, from 0
/// @param compute    called with the seconds that the part computes
template <class Compute>
void run_to_next_exchange(const HaloStrategy& strategy, const PartTimes& times, int exchanges,
                          Halo& halo, int number, bool is_last, Compute&& compute) {
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

/// Predicted time of a step of all parts [s], after they have settled into a steady rhythm.
double predicted_step_s(const PlannedStrategy& planned, const Network& network);

} // namespace dss
