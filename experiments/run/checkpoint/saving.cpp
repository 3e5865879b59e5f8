#include "experiments/run/checkpoint/saving.hpp"

#include "experiments/base/exit_code.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace dss {

long steps_of_pause(double elements) {
  constexpr double element_steps = 2e7;
  return std::clamp(long(element_steps / elements), 1L, signal_steps);
}

Saving common_saving(Executor& executor, bool is_due, bool is_asked) {
  constexpr int due = 1, asked = 2;
  const std::vector<double> ranks = gather(executor, (is_due ? due : 0) + (is_asked ? asked : 0));
  const auto has_asked = [](double of_rank) { return (int(of_rank) & asked) != 0; };
  if (std::ranges::any_of(ranks, has_asked)) return Saving::save_and_end;
  return (int(ranks.front()) & due) != 0 ? Saving::save : Saving::none;
}

void end_saved(const InterruptsDeferred& interrupts, const std::string& failure, long step,
               const std::string& checkpoint) {
  end_variants(exit_success, true);
  interrupts.end(failure.empty()
                     ? fmt::format("after step {0}; {1} has the state, so give the command again "
                                   "with --restart {1}",
                                   step, checkpoint)
                     : failure + "; an earlier checkpoint, if there is one, is whole");
}

} // namespace dss
