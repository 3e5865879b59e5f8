#include "experiments/run/state/restricted_oracle.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/needs.hpp"
#include "solver/reference/oracle.hpp"

#include <array>
#include <cmath>

namespace dss {
namespace {

/// Holds degrees of freedom of every element, in addition to the clamps.
void hold(Problem& problem, int dofs) {
  std::vector<Clamp> clamps(problem.lattice.element_count);
  for (std::size_t e = 0; e < clamps.size(); ++e) clamps[e] = {e, std::uint8_t(dofs)};
  for (const Clamp& clamp : problem.clamps) clamps[clamp.element].dofs |= clamp.dofs;
  if (dofs != 0) problem.clamps = std::move(clamps);
}

/// Sets the held degrees of freedom of the initial state to zero.
void clear(std::vector<double>& state, int dofs) {
  for (std::size_t e = 0; e < state.size(); e += field_count) {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (dofs & (dof_ux << axis))
        state[e + std::size_t(ux + axis)] = state[e + std::size_t(vx + axis)] = 0;
      if (dofs & (dof_rx << axis))
        state[e + std::size_t(qx + axis)] = state[e + std::size_t(wx + axis)] = 0;
      square += state[e + std::size_t(qx + axis)] * state[e + std::size_t(qx + axis)];
    }
    // of unit length
    if (dofs & (dof_rx | dof_ry | dof_rz)) state[e + qs] = -square / (1 + std::sqrt(1 - square));
  }
}

} // namespace

std::vector<double> restricted_state(const Problem& problem, Model model, const Method& method,
                                     double dt, long steps) {
  Problem held = problem;
  const int missing = dof_all & ~degrees_of(model);
  hold(held, missing);
  std::vector<double> state = initial_state(problem);
  clear(state, missing);
  Oracle<double> oracle(held, method, dt, rotation_of(model));
  oracle.write(state);
  if (const auto breakdown = oracle.advance(steps))
    throw UnstableError(breakdown_text(breakdown->what, breakdown->step, dt, breakdown->element));
  oracle.read(state);
  return state;
}

} // namespace dss
