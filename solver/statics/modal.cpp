#include "solver/statics/modal.hpp"
#include "solver/error.hpp"
#include "solver/numerics/spectrum.hpp"

#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

constexpr double negligible = 1e-13; ///< eigenvalue that counts as zero, over the largest
/// Shift below zero if there are modes without stiffness, over the largest eigenvalue.
constexpr double shift_share = 1e-10;
constexpr long most_free_motions = 60;

/// Unit acceleration of the frame along each axis, on the free degrees of freedom.
Eigen::MatrixXd unit_motions(const FreeDofs& dofs) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(dofs.size(), 3);
  for (Eigen::Index n = 0; n < dofs.size(); ++n)
    if (const std::size_t d = dofs.dof[std::size_t(n)] % 6; d < 3) motions(n, Eigen::Index(d)) = 1;
  return motions;
}

/// Finds the element with most of a mode's kinetic energy, which is half of shape . M shape.
void find_element(const FreeDofs& dofs, const Eigen::VectorXd& moved, NaturalMode& mode) {
  const Eigen::VectorXd energy = mode.shape.cwiseProduct(moved);
  double own = 0;
  for (std::size_t n = 0; n < dofs.dof.size(); ++n) {
    const std::size_t element = dofs.dof[n] / 6;
    own = n > 0 && dofs.dof[n - 1] / 6 == element ? own + energy[Eigen::Index(n)]
                                                  : energy[Eigen::Index(n)];
    if (own > mode.element_share) mode.element_share = own, mode.element = element;
  }
  mode.element_share /= energy.sum();
}

/// Rotates shapes of equal frequency among each other: the first follows the frame as much as
/// possible along one axis, the next along another. Otherwise rounding would mix the pair of modes
/// of a square beam.
void align_equal_modes(const Eigen::VectorXd& values, const Eigen::MatrixXd& taken,
                       Eigen::MatrixXd& shapes) {
  for (Eigen::Index first = 0, next = 0; first < values.size(); first = next) {
    for (next = first + 1;
         next < values.size() && values[next] - values[first] <= 1e-8 * std::abs(values[first]);)
      ++next;
    if (next == first + 1) continue;
    auto equal = shapes.middleCols(first, next - first);
    const Eigen::MatrixXd participation = equal.transpose() * taken;
    const Eigen::MatrixXd turn =
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(participation).householderQ();
    equal = (equal * turn).eval();
  }
}

} // namespace

ModalAnalysis find_modes(const StaticSystem& system, int count, const StaticSystem::State& state,
                         bool is_rest) {
  const SparseMatrix stiffness = is_rest ? system.stiffness_at_rest() : system.tangent(state);
  const SparseMatrix mass = system.mass(state);
  const double omega_max = spectrum_bound(system.problem()).omega_max,
               largest = omega_max * omega_max;
  const std::string& name = system.problem().name;
  if (largest == 0)
    throw InputError(fmt::format("{}: no link or tie has a stiffness: there are no modes", name));
  if (const long negative = count_below(stiffness, mass, -negligible * largest); negative > 0)
    throw UnstableError(
        fmt::format("{}: the loads buckle the body: {} mode{} of the loaded state would grow; take "
                    "smaller loads",
                    name, negative, negative == 1 ? "" : "s"));
  ModalAnalysis analysis;
  analysis.free_motions = count_below(stiffness, mass, negligible * largest);
  if (analysis.free_motions > most_free_motions)
    throw InputError(fmt::format(
        "{}: {} motions strain no link (mechanisms, as of links without rotational springs); "
        "give links rotational springs, or take a model without them: --model planar",
        name, analysis.free_motions));
  const Eigen::Index available = system.size() - analysis.free_motions;
  const double shift = analysis.free_motions > 0 ? -shift_share * largest : 0;
  const int all = int(analysis.free_motions + std::min<Eigen::Index>(count, available));
  Eigenmodes found = lowest_modes(stiffness, mass, all, shift);

  const Eigen::MatrixXd motions = unit_motions(system.dofs());
  const Eigen::MatrixXd taken = mass.selfadjointView<Eigen::Lower>() * motions;
  align_equal_modes(found.values, taken, found.shapes);
  const Eigen::MatrixXd moved = mass.selfadjointView<Eigen::Lower>() * found.shapes;
  for (int axis = 0; axis < 3; ++axis)
    analysis.free_mass[std::size_t(axis)] = motions.col(axis).dot(taken.col(axis));
  for (Eigen::Index n = analysis.free_motions; n < found.values.size(); ++n) {
    NaturalMode mode;
    mode.omega = std::sqrt(std::max(0.0, found.values[n]));
    mode.shape = found.shapes.col(n);
    for (int axis = 0; axis < 3; ++axis) {
      const double participation = mode.shape.dot(taken.col(axis));
      mode.effective_mass[std::size_t(axis)] = participation * participation;
    }
    find_element(system.dofs(), moved.col(n), mode);
    analysis.modes.push_back(std::move(mode));
  }
  return analysis;
}

} // namespace dss
