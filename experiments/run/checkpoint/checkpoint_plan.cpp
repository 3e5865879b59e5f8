#include "experiments/run/checkpoint/checkpoint_plan.hpp"

#include "solver/error.hpp"

#include <charconv>
#include <fmt/format.h>

namespace dss {

CheckpointInterval parse_checkpoint_interval(const std::string& text) {
  const bool is_time = text.ends_with('s');
  const char *begin = text.data(), *end = text.data() + text.size() - (is_time ? 1 : 0);
  CheckpointInterval interval;
  const auto read = [&](auto& value) {
    const auto [rest, error] = std::from_chars(begin, end, value);
    return error == std::errc() && rest == end && value > 0;
  };
  constexpr double most = 1e15;
  const bool is_read = is_time ? read(interval.seconds) && interval.seconds <= most
                               : read(interval.steps) && double(interval.steps) <= most;
  if (!is_read)
    throw InputError(fmt::format("--checkpoint-every {}: not a time such as 60s, nor a positive "
                                 "number of steps",
                                 text));
  return interval;
}

void require_sound_checkpoints(const RunRequest& request, const RunPlan& plan) {
  parse_checkpoint_interval(request.checkpoint_every);
  if (!request.has_checkpoint()) return;
  const char* option = request.restart.empty() ? "--checkpoint" : "--restart";
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}", option, why));
  };
  if (request.samples > 1 || request.repeat_for > 0)
    refuse("a run that is repeated for its time has none; leave --samples and --repeat-for out");
  if (!request.reference.empty())
    refuse("errors against a solution are of the whole run; leave --reference out");
  if (plan.method->has_leaps())
    refuse("the bits of leaps depend on where they end; give another --integrator");
  if (plan.plugin->solves_equations()) refuse_saving(request, plan.plugin->name);
}

void refuse_saving(const RunRequest& request, std::string_view variant) {
  throw InputError(fmt::format("{}: variant {} cannot save what its methods keep; give another "
                               "--variant",
                               request.restart.empty() ? "--checkpoint" : "--restart", variant));
}

void refuse_passed_state(const RunRequest& request, long step) {
  throw InputError(fmt::format("{}: the state of --check-state, at step {}, was passed; leave it "
                               "out",
                               request.restart, step));
}

} // namespace dss
