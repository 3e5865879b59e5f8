#include "solver/statics/static_system.hpp"

#include "solver/error.hpp"
#include "solver/reference/rotation_vector.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <string_view>

namespace dss {
namespace {

using Real = StaticSystem::Real;

std::vector<double> signals_at_end(const Problem& problem, double factor) {
  const double end = problem.dt * double(problem.steps);
  std::vector<double> signals;
  for (const Signal& signal : problem.frame_acceleration) signals.push_back(factor * signal(end));
  for (const Load& load : problem.loads) signals.push_back(factor * load.signal(end));
  return signals;
}

} // namespace

FreeDofs free_dofs(const Problem& problem, std::uint8_t dofs) {
  const std::size_t elements = problem.lattice.element_count;
  std::vector<std::uint8_t> held(elements, std::uint8_t(dof_all & ~dofs));
  for (const Clamp& clamp : problem.clamps) held[clamp.element] |= clamp.dofs;
  FreeDofs found;
  found.index.assign(6 * elements, -1);
  for (std::size_t n = 0; n < found.index.size(); ++n) {
    if (held[n / 6] >> (n % 6) & 1) continue;
    found.index[n] = found.size();
    found.dof.push_back(n);
  }
  if (found.dof.empty())
    throw InputError(
        fmt::format("{}: every degree of freedom is clamped; free some", problem.name));
  return found;
}

std::string dof_text(const Problem& problem, std::size_t dof) {
  std::string text;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    if (e == dof / 6)
      text = fmt::format("{} of element {} of body \"{}\"", dof_names[dof % 6], e,
                         problem.bodies[std::size_t(row.body)].name);
  });
  return text;
}

StaticSystem::StaticSystem(const Problem& problem, Rotation law, std::uint8_t dofs, double loads)
    : problem_(problem), moving_(dofs), dofs_(free_dofs(problem, dofs)), dynamics_(problem, law),
      signals_(signals_at_end(problem, loads)), edge_(shortest_edge(problem)) {
  if (problem.has_rotating_frame())
    throw InputError(
        fmt::format("{}: its frame rotates, so this analysis has no state of rest; run "
                    "it in time (--analysis dynamic)",
                    problem.name));
  problem.lattice.for_each_element(
      [&](std::size_t, const Row& row, int) { body_.push_back(row.body); });
}

StaticSystem::State StaticSystem::inside(std::span<const double> fields) {
  State state(fields.begin(), fields.end());
  for (std::size_t e = 0; e < body_.size(); ++e) {
    Real* of_element = &state[e * field_count];
    for (std::size_t a = 0; a < 3; ++a) of_element[vx + a] = of_element[wx + a] = 0;
    const auto inside = dynamics_.coordinates().write(e, reference::orientation_fields(of_element));
    reference::set_orientation_fields(of_element, inside);
  }
  return state;
}

std::vector<double> StaticSystem::fields(const State& state) const {
  State outside = state;
  for (std::size_t e = 0; e < body_.size(); ++e) {
    Real* of_element = &outside[e * field_count];
    const auto q = dynamics_.coordinates().read(e, reference::orientation_fields(of_element));
    reference::set_orientation_fields(of_element, q);
  }
  return {outside.begin(), outside.end()};
}

StaticSystem::Vector StaticSystem::free_part(const std::vector<Real>& all) const {
  Vector forces(size());
  for (Eigen::Index n = 0; n < size(); ++n) forces[n] = all[dofs_.dof[std::size_t(n)]];
  return forces;
}

StaticSystem::Vector StaticSystem::unbalanced(const State& state, double share) {
  std::vector<double> signals = signals_;
  for (double& signal : signals) signal *= share;
  std::vector<Real> all(6 * body_.size());
  dynamics_.wrenches(state, signals, all);
  return free_part(all);
}

void StaticSystem::turn_fields(Real* fields, const reference::Vector<Real>& turn) const {
  reference::Orientation<Real> now = reference::orientation_fields(fields);
  if (dynamics_.coordinates().has_vectors())
    now.v += turn;
  else
    now = reference::product(reference::orientation_of_vector(turn), now);
  reference::set_orientation_fields(fields, now);
}

void StaticSystem::move(State& state, const Eigen::VectorXd& step) const {
  for (std::size_t e = 0; e < body_.size(); ++e) {
    Real* fields = &state[e * field_count];
    reference::Vector<Real> turn = reference::Vector<Real>::Zero();
    for (int d = 0; d < 6; ++d) {
      const Eigen::Index n = dofs_.index[6 * e + std::size_t(d)];
      if (n < 0) continue;
      if (d < 3)
        fields[ux + d] += step[n];
      else
        turn[d - 3] = step[n];
    }
    turn_fields(fields, turn);
  }
}

double StaticSystem::norm(const Vector& forces) const {
  Real sum = 0;
  for (Eigen::Index n = 0; n < size(); ++n) {
    const Real force = dofs_.dof[std::size_t(n)] % 6 < 3 ? forces[n] : forces[n] / Real(edge_);
    sum += force * force;
  }
  return double(std::sqrt(sum));
}

double StaticSystem::residual(const State& state) {
  const double loads = load_norm(), left = norm(unbalanced(state));
  return loads > 0 ? left / loads : left;
}

double StaticSystem::load_norm() const {
  std::vector<Real> all(6 * body_.size(), 0);
  for (std::size_t e = 0; e < body_.size(); ++e)
    for (std::size_t a = 0; a < 3; ++a)
      all[6 * e + a] = problem_.mass(e, problem_.bodies[std::size_t(body_[e])]) * signals_[a];
  for (std::size_t l = 0; l < problem_.loads.size(); ++l)
    for (const std::size_t e : problem_.loads[l].elements)
      for (std::size_t a = 0; a < 3; ++a) {
        all[6 * e + a] += signals_[3 + l] * problem_.loads[l].force[a];
        all[6 * e + 3 + a] += signals_[3 + l] * problem_.loads[l].torque[a];
      }
  return norm(free_part(all));
}

Problem held_still(const Problem& problem, double loads) {
  Problem still = problem;
  const std::vector<double> signals = signals_at_end(problem, loads);
  const auto constant = [](double value) {
    Signal signal;
    signal.amplitude = value;
    return signal;
  };
  for (std::size_t l = 0; l < still.loads.size(); ++l)
    still.loads[l].signal = constant(signals[3 + l]);
  for (Signal& signal : still.frame_acceleration) signal = constant(0);
  if (signals[0] == 0 && signals[1] == 0 && signals[2] == 0) return still;
  std::map<double, Load> weights; // by mass
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    weights[problem.mass(e, problem.bodies[std::size_t(row.body)])].elements.push_back(e);
  });
  for (auto& [mass, weight] : weights) {
    for (std::size_t a = 0; a < 3; ++a) weight.force[a] = mass * signals[a];
    still.loads.push_back(weight);
  }
  return still;
}

} // namespace dss
