#pragma once
/// A bound of what the models of small rotations (bending, membrane, linear, small) leave out, from states of the run itself. Derivation and what it was compared with:
/// README.md beside this file.
#include "solver/model/model.hpp"
#include "solver/model/sufficiency/bound_structure.hpp"

#include <array>
#include <span>
#include <vector>

namespace dss {

/// One number for each kind of field: u [m], q, v [m/s], w [rad/s].
using KindBounds = std::array<double, 4>;

class ModelErrorBound {
public:
  /// `problem` must outlive it.
  ModelErrorBound(const Problem& problem, Model model);
  /// Takes in the state of all elements at a time [s], not before that of the last look.
  void look(std::span<const double> state, double time);
  /// Bound of the errors at the last look, or after so much more time [s] of the present speeds.
  KindBounds errors(double ahead = 0) const;
  /// Largest of each kind met so far.
  const KindBounds& largest() const { return largest_; }
  double largest_rotation() const { return rotation_; } ///< of an element against its rest [rad]
  double largest_force() const { return force_; }       ///< of a link [N], where the bound needs it
  const BoundStructure& structure() const { return structure_; }

private:
  void look_at_links(std::span<const double> state);
  double operator_error(double rotation, double growth) const;
  KindBounds turned_forces(double rotation, double growth, double time) const;
  bool needs_links() const { return !structure_.is_flat && (model_ != Model::small || !structure_.is_tree); }

  const Problem& problem_;
  const Model model_;
  const BoundStructure structure_;
  KindBounds largest_{};
  double rotation_ = 0, spin_ = 0;        ///< [rad], of now [rad/s]
  double force_ = 0, gap_ = 0, rate_ = 0; ///< of links, largest [N], [m], [m/s]
  double strain_energy_ = 0,
         arms_energy_ = 0;      ///< twice the largest elastic energy, and that of arms of wrong length [J]
  double cycles_ = 0;           ///< integral of the frequency of the motion [rad]
  double start_ = 0, time_ = 0; ///< [s]
  bool has_begun_ = false;
  std::vector<int> body_of_; ///< of each element, where links are looked at
};

} // namespace dss
