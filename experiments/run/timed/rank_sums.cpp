#include "experiments/run/timed/rank_sums.hpp"

#include <algorithm>
#include <numeric>

namespace dss {

static double sum(Executor& executor, double own) {
  const std::vector<double> of_ranks = gather(executor, own);
  return std::accumulate(of_ranks.begin(), of_ranks.end(), 0.0);
}

Usage of_all_ranks(Executor& executor, Usage usage) {
  const auto largest = [&](double own) { return std::ranges::max(gather(executor, own)); };
  // Each rank counts the other ranks among what ran beside it on its machine.
  const double machine_s = largest(usage.others_s + usage.cpu_s);
  usage.cpu_s = sum(executor, usage.cpu_s);
  usage.wait_s = sum(executor, usage.wait_s);
  usage.involuntary_switches = long(sum(executor, double(usage.involuntary_switches)));
  usage.steal_s = largest(usage.steal_s);
  usage.others_s = machine_s - usage.cpu_s;
  return usage;
}

void put_traffic(Executor& executor, const Traffic& sent, double steps, RunResult& result) {
  result.messages_per_step = sum(executor, sent.messages) / steps;
  result.bytes_per_step = sum(executor, sent.bytes) / steps;
  result.communication_share = sum(executor, sent.wait_s) / (result.wall_s * result.ranks.ranks);
}

} // namespace dss
