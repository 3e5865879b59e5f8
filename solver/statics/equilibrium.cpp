#include "solver/statics/equilibrium.hpp"
#include "solver/error.hpp"
#include "solver/statics/held.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace dss {
namespace {

constexpr int most_corrections = 40;          ///< under the same loads
constexpr double largest_turn = 0.5;          ///< of one correction [rad]
constexpr double large_turn = 1e-3;           ///< first turn [rad] that calls for a new matrix
constexpr double least_increment = 1.0 / 256; ///< of the loads
/// Relative correction that counts as found if rounding keeps it from falling further.
constexpr double near_enough = 1e-9;

/// Conjugate gradients take about 30 iterations for each element along the longest side, because
/// information crosses the body once.
double expected_iterations(const Problem& problem) {
  int longest = 1;
  for (const Row& row : problem.lattice.rows)
    longest = std::max({longest, row.x_end - row.x_begin, row.y + 1, row.z + 1});
  return 30.0 * longest;
}

class Iteration {
public:
  Iteration(StaticSystem& system, const EquilibriumOptions& options)
      : system_(system), options_(options),
        solver_(options.solver, options.preconditioner, expected_iterations(system.problem())),
        edge_(shortest_edge(system.problem())) {}

  Equilibrium run(const StaticSystem::State& start) {
    found_.state = start.empty() ? system_.rest() : start;
    const SparseMatrix stiffness = start.empty() ? system_.stiffness_at_rest() : matrix();
    prepare(stiffness);
    if (const std::string dof = forceless(stiffness); !dof.empty()) avoid_mechanism(dof, stiffness);
    double share = 0, increment = 1;
    while (share < 1 && found_.reason.empty()) {
      const double target = std::min(1.0, share + increment);
      if (corrected(target)) {
        ++found_.increments;
        share = target;
        increment *= 2;
      } else if (system_.is_linear() || (increment /= 2) < least_increment) {
        found_.reason = failure(share);
      }
    }
    finish();
    return found_;
  }

private:
  SparseMatrix matrix() const {
    return system_.is_linear() ? system_.stiffness_at_rest() : system_.tangent(found_.state);
  }

  void prepare(const SparseMatrix& stiffness) {
    solver_.prepare(stiffness);
    ++found_.matrices;
  }

  /// Degree of freedom that moves without any force, as text; empty if there is none.
  std::string forceless(const SparseMatrix& stiffness) const {
    if (!solver_.is_direct() || !options_.must_be_stable) return {};
    const std::optional<Eigen::Index> zero = solver_.factors().zero_pivot(stiffness);
    return zero ? dof_text(system_.problem(), system_.dofs().dof[std::size_t(*zero)]) : "";
  }

  void avoid_mechanism(const std::string& dof, const SparseMatrix& stiffness) {
    if (options_.solver != SolverKind::automatic)
      throw InputError(fmt::format(
          "{}: {} moves without any force: no link resists it (a mechanism, as of links without "
          "rotational springs); clamp it, give springs, or take --solver cg or relaxation, "
          "which may pass it by",
          system_.problem().name, dof));
    found_.note =
        fmt::format("{} moves without any force, and no load drives it (a mechanism)", dof);
    solver_.take_conjugate_gradients();
    prepare(stiffness);
  }

  /// Largest displacement of a correction [m]. Turns are multiplied by the shortest edge.
  double size_of(const Eigen::VectorXd& step) const {
    double largest = 0;
    for (Eigen::Index n = 0; n < step.size(); ++n)
      largest = std::max(largest, std::abs(step[n]) * (is_turn(n) ? edge_ : 1));
    return largest;
  }
  bool is_turn(Eigen::Index n) const { return system_.dofs().dof[std::size_t(n)] % 6 >= 3; }

  double size_of(const StaticSystem::State& state) const {
    StaticSystem::Real largest = 0;
    for (std::size_t n = 0; n < state.size(); ++n) {
      const auto field = int(n % field_count);
      if (field <= uz) largest = std::max(largest, std::abs(state[n]));
      if (field >= qx && field <= qz)
        largest = std::max(largest, 2 * StaticSystem::Real(edge_) * std::abs(state[n]));
    }
    return double(largest);
  }

  /// Largest turn of a correction [rad].
  double turn_of(const Eigen::VectorXd& step) const {
    double turn = 0;
    for (Eigen::Index n = 0; n < step.size(); ++n)
      if (is_turn(n)) turn = std::max(turn, std::abs(step[n]));
    return turn;
  }

  /// Corrects the state until it carries `share` of the loads. If that fails, the state is
  /// unchanged.
  bool corrected(double share) {
    const StaticSystem::State before = found_.state;
    double last = std::numeric_limits<double>::infinity();
    bool is_of_here = true; // the matrix belongs to the present state
    for (int n = 0; n < most_corrections; ++n) {
      auto step =
          solver_.solve(system_.unbalanced(found_.state, share).cast<double>(), cg_reduction());
      if (!step || !step->allFinite()) break;
      const double turn = turn_of(*step);
      if (turn > largest_turn && !system_.is_linear()) *step *= largest_turn / turn;
      system_.move(found_.state, *step);
      ++found_.iterations;
      const double size = size_of(*step), of_state = size_of(found_.state);
      found_.correction = of_state > 0 ? size / of_state : 0;
      const bool is_stuck = is_of_here && size > 0.5 * last;
      if (found_.correction <= options_.tolerance || (found_.correction < near_enough && is_stuck))
        return true;
      is_of_here = system_.is_linear();
      if (!is_of_here && (size > 0.1 * last || (n == 0 && turn > large_turn))) {
        prepare(system_.tangent(found_.state));
        is_of_here = true;
      }
      last = size;
    }
    found_.state = before;
    if (!system_.is_linear()) prepare(system_.tangent(found_.state));
    return false;
  }
  double cg_reduction() const { return system_.is_linear() ? 1e-10 : 1e-6; }

  std::string failure(double share) const {
    if (!solver_.is_direct())
      return solver_.met_no_stiffness() ? "conjugate gradients met a motion without stiffness: "
                                          "something is free to move, or has buckled"
                                        : fmt::format("conjugate gradients did not converge in {} "
                                                      "iterations: is something free to move?",
                                                      solver_.iterations());
    return fmt::format("no equilibrium was found beyond {:.4g} of the loads; take smaller ones, or "
                       "--solver relaxation",
                       share);
  }

  void finish() {
    found_.solver = solver_.name();
    found_.cg_iterations = solver_.iterations();
    found_.is_found = found_.reason.empty();
    found_.residual = system_.residual(found_.state);
    if (!found_.is_found || system_.is_linear() || !solver_.is_direct() || !options_.must_be_stable)
      return;
    const SparseMatrix tangent = system_.tangent(found_.state);
    prepare(tangent);
    if (const std::string dof = forceless(tangent); !dof.empty())
      throw UnstableError(fmt::format(
          "{}: {} moves without any force in the loaded state, which is on the point of "
          "buckling; take smaller loads",
          system_.problem().name, dof));
    if (const long negative = solver_.factors().negative_pivots(); negative > 0)
      throw UnstableError(fmt::format(
          "{}: the equilibrium that was found is not stable: the loads buckle the body in "
          "{} mode{}; take smaller ones",
          system_.problem().name, negative, negative == 1 ? "" : "s"));
  }

  StaticSystem& system_;
  const EquilibriumOptions& options_;
  SparseSolver solver_;
  double edge_;
  Equilibrium found_;
};

} // namespace

Equilibrium find_equilibrium(StaticSystem& system, const EquilibriumOptions& options,
                             const StaticSystem::State& start) {
  if (const std::string why = why_not_held(system.problem(), system.moving()); !why.empty())
    throw InputError(fmt::format("{}: {}", system.problem().name, why));
  return Iteration(system, options).run(start);
}

} // namespace dss
