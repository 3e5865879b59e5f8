#pragma once
/// The largest step of each method that a run may have.
#include "experiments/runner/precision/saved_times.hpp"
#include "solver/model/problem.hpp"

#include <map>
#include <string_view>

namespace dss {

/// Steps between saved times at the largest step that `dssbench run` accepts, by explicit method; rkc2 takes any, with as many stages as that needs. Methods that
/// no step keeps stable are not in it. Limits of more than 32 elements are the lower
/// bounds of stable_step.
/// @throws UnstableError if rk4 or dopri5 is none of them
std::map<std::string_view, long> first_steps(const Problem& problem, const SavedTimes& times);

/// Whether a number of stages of rkc2 is stable with a step dt [s], as the bound of stable_step knows at once: `fitted` then finds it without a sharp limit.
bool has_stages(const Problem& problem, double dt);

} // namespace dss
