#pragma once
/// The largest stable step of each method.
#include "experiments/run/state/saved_times.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <map>
#include <string_view>

namespace dss {

/// Number of steps between saved times at the largest step that `dssbench run` accepts, by explicit
/// method, and by faber if the problem has a linear model. rkc2 and faber take most steps and adapt
/// their stages. Methods without a stable step are absent. Above 32 elements, the limits are the
/// lower bounds of stable_step.
/// @throws UnstableError if rk4 or dopri5 is absent
std::map<std::string_view, long> first_steps(const Problem& problem, const SavedTimes& times);

/// A fitted method with so many steps of dt [s]. Without stages if it cannot have them, because no
/// number of stages of rkc2 is stable by the bound of stable_step, or because signals are no
/// polynomials in steps of faber.
Method fitted_or_none(const Problem& problem, const Method& method, double dt, long steps);

} // namespace dss
