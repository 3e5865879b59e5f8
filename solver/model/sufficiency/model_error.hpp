#pragma once
/// Bound of what the models of small rotations (bending, membrane, linear, small) leave out, from
/// states of the run. README.md beside this file has the derivation and the comparison with the
/// oracle.
#include "kernels/model.hpp"
#include "solver/model/sufficiency/bound_structure.hpp"

#include <array>
#include <span>
#include <vector>

namespace dss {

/// One number for each kind of field: u [m], q (of a unit quaternion), v [m/s], w [rad/s].
using KindBounds = std::array<double, 4>;

/// Bound of the error of a model during a run. Call look() at states in the order of time, then
/// errors().
class ModelErrorBound {
public:
  /// `problem` must outlive this object.
  ModelErrorBound(const Problem& problem, Model model);
  /// Adds the state of all elements at `time` [s], which is not before the last look.
  void look(std::span<const double> state, double time);
  /// Bound of the errors at the last look, or after `ahead` [s] more at the present speeds.
  KindBounds errors(double ahead = 0) const;
  /// Largest value of each kind so far.
  const KindBounds& largest() const { return largest_; }
  double largest_rotation() const {
    return rotation_;
  } ///< of an element from its rest orientation [rad]
  double largest_force() const {
    return force_;
  } ///< of a link [N]; 0 if the bound does not need it
  const BoundStructure& structure() const { return structure_; }
  /// Visits what a continued run needs (solver/io/kept_numbers.hpp).
  template <class Visit>
  void each_kept(Visit&& visit) {
    visit(largest_), visit(rotation_), visit(spin_), visit(force_), visit(gap_), visit(rate_);
    visit(strain_energy_), visit(arms_energy_), visit(cycles_), visit(start_), visit(time_);
    visit(has_begun_);
  }

private:
  std::vector<double> pressures_of(std::span<const double> state) const;
  void look_at_links(std::span<const double> state);
  double operator_error(double rotation, double growth) const;
  KindBounds turned_forces(double rotation, double growth, double time) const;
  bool needs_links() const {
    return !structure_.is_flat && (model_ != Model::small || !structure_.is_tree);
  }

  const Problem& problem_;
  const Model model_;
  const BoundStructure structure_;
  KindBounds largest_{};
  double rotation_ = 0, spin_ = 0;        ///< [rad]; spin_: at the last look [rad/s]
  double force_ = 0, gap_ = 0, rate_ = 0; ///< largest of all links [N], [m], [m/s]
  /// Twice the largest elastic energy; twice the energy of arms of wrong length [J].
  double strain_energy_ = 0, arms_energy_ = 0;
  double cycles_ = 0;           ///< integral of the motion's frequency over time [rad]
  double start_ = 0, time_ = 0; ///< [s]
  bool has_begun_ = false;
  std::vector<int> body_of_; ///< body of each element, if links are needed
};

} // namespace dss
