#pragma once
/// What the runner does with the state of an executor: in pieces, so that a large state is never held twice.
#include "solver/model/problem.hpp"
#include "variants/api.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace dss {

/// Sets the initial state of the problem; restarts the method.
void write_initial_state(Executor& executor, const Problem& problem);

/// Calls visit(first element, fields) for the whole state, some thousand elements at a time.
void for_each_piece(Executor& executor, std::size_t element_count,
                    const std::function<void(std::size_t, std::span<const double>)>& visit);

/// The whole state, 13 numbers an element.
std::vector<double> whole_state(Executor& executor, std::size_t element_count);

/// The first element with a number that is not finite, if there is one.
std::optional<std::size_t> first_not_finite(Executor& executor, std::size_t element_count);

/// Largest length of a displacement [m].
double max_displacement(Executor& executor, std::size_t element_count);

/// 64-bit digest of a state's bits (FNV-1a over its 64-bit words). -0 counts as +0, and so does what may or may not
/// have been flushed: numbers below 2^-1000 (f64) or 2^-120 (f32) (DESIGN.md section 6).
class StateDigest {
public:
  explicit StateDigest(Precision precision) : smallest_(precision == Precision::f64 ? 0x1p-1000 : 0x1p-120) {}
  void add(std::span<const double> fields);
  std::uint64_t value() const { return hash_; }

private:
  double smallest_;
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// Digest of an executor's state.
std::uint64_t state_digest(Executor& executor, std::size_t element_count, Precision precision);

/// One number for each kind of field: u, q (s, x, y, z), v, w.
using KindValues = std::array<double, 4>;

/// Largest number of each kind in a state.
KindValues largest_of_kinds(std::span<const double> state);

/// Largest difference of each kind; infinite where a number is not finite.
KindValues largest_differences(std::span<const double> expected, std::span<const double> actual);

/// What differences are measured against: the largest expected number of the kind, or a thousandth of its partner (u and q h, v and w h,
/// with h the shortest edge) where it is negligible beside that: what is zero but for rounding has no digits of its own.
KindValues error_scales(const Problem& problem, const KindValues& largest_expected);

/// A difference over its scale: 0 where there is none, infinite for one where nothing is expected.
inline double relative(double difference, double scale) { return difference > 0 ? difference / scale : 0; }

/// Largest relative error of a state (or of its time derivative) against the expected one: the maximum over the kinds
/// of max|difference| / scale (error_scales). Infinite where a number is not finite.
double state_error(const Problem& problem, std::span<const double> expected, std::span<const double> actual);

} // namespace dss
