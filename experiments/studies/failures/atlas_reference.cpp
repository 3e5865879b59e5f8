#include "experiments/studies/failures/atlas_reference.hpp"
#include "experiments/run/state/oracle_state.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/numerics/stability.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {

std::vector<double> converged_state(const Problem& problem, double t, double tolerance) {
  constexpr int most_halvings = 12;
  const Method& method = *find_method("rk4");
  const double limit = std::min(0.5 * stable_step(problem, method, true).dt, t / 16);
  long steps = std::lround(std::ceil(t / limit));
  std::vector<double> coarse =
      compute_oracle_state(problem, method, Rotation::quaternion, t / double(steps), steps, {})
          .state;
  double change = 0;
  for (int halving = 0; halving < most_halvings; ++halving) {
    steps *= 2;
    std::vector<double> fine =
        compute_oracle_state(problem, method, Rotation::quaternion, t / double(steps), steps, {})
            .state;
    change = state_error(problem, fine, coarse);
    if (change < tolerance) return fine;
    coarse = std::move(fine);
  }
  throw InputError(fmt::format(
      "{}: the oracle's state at {:g} s still changes by {:.2g} with {} steps; {:g} was asked for",
      problem.name, t, change, steps, tolerance));
}

void align_turns(std::vector<double>& expected, const std::vector<double>& actual) {
  for (std::size_t e = 0; e < expected.size(); e += field_count) {
    double product = (1 + expected[e + qs]) * (1 + actual[e + qs]);
    for (const int n : {qx, qy, qz})
      product += expected[e + std::size_t(n)] * actual[e + std::size_t(n)];
    if (product >= 0) continue;
    expected[e + qs] = -2 - expected[e + qs];
    for (const int n : {qx, qy, qz}) expected[e + std::size_t(n)] *= -1;
  }
}

const std::vector<double>& AtlasReferences::at(double t) {
  const auto known = states_.find(t);
  if (known != states_.end()) return known->second;
  std::vector<double> state;
  if (reference_.form != nullptr)
    state = closed(t);
  else if (reference_.scene.empty())
    state = converged_state(scene_.problem, t, reference_.converged);
  else
    state = other_scene(t);
  return states_.emplace(t, std::move(state)).first->second;
}

std::vector<double> AtlasReferences::closed(double t) const {
  Parameters arguments;
  for (const auto& [name, formula] : reference_.arguments)
    arguments[name] = formula(scene_.parameters);
  const std::size_t count = scene_.problem.lattice.element_count;
  if (const auto element = arguments.find("element"); element != arguments.end())
    if (!(element->second >= 0 && element->second < double(count)))
      throw InputError(fmt::format("closed form {}: element {:g} is not one of the {} of {}",
                                   reference_.form->name, element->second, count, scene_.path));
  return reference_.form->state(scene_.problem, arguments, t);
}

std::vector<double> AtlasReferences::other_scene(double t) const {
  const Scene other = load_scene(reference_.scene, set_);
  std::vector<double> state = converged_state(other.problem, t, reference_.converged);
  if (state.size() != scene_.problem.lattice.element_count * field_count ||
      reference_.base * field_count >= state.size())
    throw InputError(fmt::format(
        "{}: has {} elements, {} has {}; a reference has as many, the base among them", other.path,
        state.size() / field_count, scene_.path, scene_.problem.lattice.element_count));
  const std::vector<double> base(state.begin() + std::ptrdiff_t(reference_.base * field_count),
                                 state.begin() +
                                     std::ptrdiff_t((reference_.base + 1) * field_count));
  for (std::size_t e = 0; e < state.size(); e += field_count)
    for (const int n : {ux, uy, uz, vx, vy, vz}) state[e + std::size_t(n)] -= base[std::size_t(n)];
  return state;
}

} // namespace dss
