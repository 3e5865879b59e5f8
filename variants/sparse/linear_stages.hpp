#pragma once
/// Stages of a linear model: M x'' + C x' + K x = f(t), x being the displacements and turns that
/// are free.
#include "solver/reference/dynamics.hpp"
#include "solver/statics/factors.hpp"
#include "solver/statics/static_system.hpp"
#include "variants/sparse/stages.hpp"

#include <utility>
#include <vector>

namespace dss {

/// Forces on the free degrees of freedom [N, N m]: loads, the frame's acceleration and what clamped
/// elements exert that are displaced. They are linear in the signals.
class LinearLoads {
public:
  /// @param dofs  outlives it
  LinearLoads(const Problem& problem, const FreeDofs& dofs);

  /// Forgets what is held.
  void restart() { first_.clear(); }
  /// @param held  fields of all elements in the oracle's coordinates, free ones zero; the first
  ///     call after a restart takes them
  /// @return valid until the next call
  const Eigen::VectorXd& at(std::span<const double> held, std::span<const double> signals);

private:
  /// Forces of a signal of one at rest, which the first change of the signal asks for.
  struct Pattern {
    std::size_t signal;
    std::vector<std::pair<Eigen::Index, double>> forces;
  };
  Eigen::VectorXd evaluated(std::span<const double> state, std::span<const double> signals);
  void add_pattern(std::size_t signal);

  const FreeDofs& dofs_;
  reference::Dynamics<double> dynamics_;
  std::vector<double> rest_, wrenches_;
  std::vector<double> first_, last_; ///< signals; empty before the first call
  std::vector<bool> has_pattern_;
  std::vector<Pattern> patterns_;
  Eigen::VectorXd of_first_, of_last_;
};

/// A state is x, then v. The accelerations a of a stage follow from
///     (M + s C + s^2 K) a = f - C v* - K (x* + s v*),   v = v* + s a
/// with one matrix for all stages of all steps.
class LinearStages final : public Stages {
public:
  /// Factorises the matrix.
  /// @param model  a linear one; `share`: s [s]
  /// @throws InputError if nothing is free to move, the factors do not fit in memory, or this
  ///     machine lacks CHOLMOD
  LinearStages(const Problem& problem, Model model, double share);

  void write(std::size_t first, std::span<const double> fields, Vector& state) override;
  void read(std::size_t first, std::span<double> fields, const Vector& state) override;
  void find_slope(const Vector& state, std::span<const double> signals, Vector& slope) override;
  std::optional<std::size_t> solve(const Vector& base, std::span<const double> signals,
                                   Vector& slope) override;
  std::size_t element_of(Eigen::Index n) const override {
    return dofs_.dof[std::size_t(n % dofs_.size())] / 6;
  }
  std::string text() const override;
  double bytes() const override;
  FactorInfo factor_info() const override { return info_; }

private:
  double share_;
  Eigen::VectorXd mass_; ///< diagonal [kg, kg m^2]
  SparseMatrix damping_, stiffness_;
  FreeDofs dofs_;
  reference::Coordinates<double> coordinates_;
  std::vector<double> held_; ///< fields in the oracle's coordinates; free ones are zero
  LinearLoads loads_;
  Factors factors_;
  FactorInfo info_;
};

} // namespace dss
