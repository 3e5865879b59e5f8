#pragma once
/// Stages of a model with finite rotations, by Newton's iteration.
#include "solver/reference/dynamics.hpp"
#include "solver/statics/factors.hpp"
#include "solver/statics/static_system.hpp"
#include "variants/sparse/stages.hpp"

#include <vector>

namespace dss {

/// A state is the fields of all elements in the oracle's coordinates. The unknowns of a stage are
/// the accelerations a of what is free. They give v = v* + s a, u = u* + s v and the orientation
/// (Coordinates::midpoint); the equations left are M (a - f_v(Y)) = 0. The matrix of Newton's
/// iteration is the symmetric part of
///     M + s C + s^2 K
/// at some earlier state, without gyroscopic moments. It is made again when corrections fall too
/// slowly, and does not change what the iteration ends at.
class NonlinearStages final : public Stages {
public:
  /// @param rotation  of the model; `share`: s [s]
  NonlinearStages(const Problem& problem, Model model, Rotation rotation, double share);

  void write(std::size_t first, std::span<const double> fields, Vector& state) override;
  void read(std::size_t first, std::span<double> fields, const Vector& state) override;
  void find_slope(const Vector& state, std::span<const double> signals, Vector& slope) override;
  std::optional<std::size_t> solve(const Vector& base, std::span<const double> signals,
                                   Vector& slope) override;
  std::size_t element_of(Eigen::Index n) const override { return std::size_t(n) / field_count; }
  std::string text() const override;
  double bytes() const override;
  FactorInfo factor_info() const override { return info_; }

private:
  bool iterate(const Vector& base, std::span<const double> signals, Vector& slope);
  void place(const Vector& base);
  void finish(const Vector& base, Vector& slope);
  bool renew_factors();
  double speed(const Vector& accelerations) const;
  double noise() const;
  std::size_t largest_of(const Vector& unknowns) const;

  double share_;
  reference::Dynamics<double> dynamics_;
  StaticSystem system_;
  std::vector<double> gyration_; ///< radius of each element [m]; makes w comparable with v
  std::vector<double> edge_;     ///< largest of each element [m]
  Vector accelerations_;         ///< first guess of the next stage
  Vector reached_;               ///< Y
  std::size_t worst_ = 0;        ///< element with the largest residual
  SparseMatrix mass_;            ///< where the factors are from
  Factors factors_;
  bool has_factors_ = false;
  FactorInfo info_;
};

} // namespace dss
