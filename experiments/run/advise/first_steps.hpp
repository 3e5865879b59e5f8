#pragma once
/// The largest stable step of each method.
#include "experiments/run/state/saved_times.hpp"
#include "solver/model/problem.hpp"

#include <map>
#include <string_view>

namespace dss {

/// Number of steps between saved times at the largest step that `dssbench run` accepts, by explicit
/// method. The method rkc2 accepts any step and adapts its stages. Methods without a stable step
/// are absent. Above 32 elements, the limits are the lower bounds of stable_step.
/// @throws UnstableError if rk4 or dopri5 is absent
std::map<std::string_view, long> first_steps(const Problem& problem, const SavedTimes& times);

/// True if some number of rkc2 stages is stable with a step dt [s] by the bound of stable_step.
/// Then `fitted` finds it without computing a sharp limit.
bool has_stages(const Problem& problem, double dt);

} // namespace dss
