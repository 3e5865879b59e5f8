#pragma once
/// Which actions a compiled row has. The rare ones would be most of a row's code and of its compile
/// time if they were inlined everywhere. So most rows call one noinline function for them
/// (apart_action), which the rows of all terms share.
#include "kernels/stage_row/row.hpp"

namespace dss {

/// Values of `fixed_action` besides a single action. The rest are the actions without a function of
/// their own in common rows.
enum ActionSet : int {
  any_action = -1,   ///< all: common ones in line, rare ones called
  rest_in_line = -2, ///< the rest, in line
  rest_called = -3,  ///< the rest, called
  apart_action = -4, ///< the function that is called
};

/// True for actions that few runs use. A new action is rare.
constexpr bool is_rare(row_action action) {
  return action != plain_stage && action != combined_stage && action != leapfrog_step &&
         action != predicted_step;
}
/// True if compensated sums are made. Double precision needs no low parts.
constexpr bool is_kept(row_action action) {
  return action == kept_stage || action == kept_step || action == kept_leapfrog ||
         action == kept_predicted || action == kept_error;
}
/// True for actions that common rows have a function of their own for (instantiate.hpp).
constexpr bool has_function(row_action action) {
  return action == plain_stage || action == combined_stage || action == predicted_step ||
         action == kept_stage || action == kept_step;
}
/// True if rows of a set (or of a single action) have the code of an action in line.
template <class T>
constexpr bool has_action(int set, row_action action) {
  if (action == bare_rates || (is_kept(action) && sizeof(T) > sizeof(float))) return false;
  if (set == any_action) return !is_rare(action);
  if (set == rest_called) return false;
  if (set == apart_action) return true;
  if (set == rest_in_line) return !has_function(action);
  return action == set;
}

} // namespace dss
