#pragma once
/// Equations of implicit stages.
#include "variants/api/capabilities.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace dss {

/// The first number that is not finite; the last number if all are.
inline Eigen::Index first_not_finite(const Eigen::VectorXd& numbers) {
  Eigen::Index n = 0;
  while (n + 1 < numbers.size() && std::isfinite(numbers[n])) ++n;
  return n;
}

/// The equations Y = Y* + s f(t, Y) of a problem, s being a fixed share of the step. States and
/// slopes f are columns of numbers, whose meaning a derived class knows.
class Stages {
public:
  using Vector = Eigen::VectorXd;
  virtual ~Stages() = default;

  /// As Executor::write and read. @param state  empty at first
  virtual void write(std::size_t first, std::span<const double> fields, Vector& state) = 0;
  virtual void read(std::size_t first, std::span<double> fields, const Vector& state) = 0;

  /// Finds f at a state. @param signals  one row of solver/numerics/signal_rows.hpp
  virtual void find_slope(const Vector& state, std::span<const double> signals, Vector& slope) = 0;
  /// Solves Y = base + s f(Y). @param slope  becomes f(Y)
  /// @return nothing; or the element where no solution was found
  virtual std::optional<std::size_t> solve(const Vector& base, std::span<const double> signals,
                                           Vector& slope) = 0;
  /// Element of a number of a state.
  virtual std::size_t element_of(Eigen::Index n) const = 0;

  /// What was solved, for the record.
  virtual std::string text() const = 0;
  virtual double bytes() const = 0;
  virtual FactorInfo factor_info() const = 0;
};

} // namespace dss
