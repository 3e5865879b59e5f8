#pragma once
/// Access to the state of an executor. Large states are handled in pieces, so that they are never
/// held twice.
#include "solver/model/problem.hpp"
#include "variants/api/api.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace dss {

/// Writes the initial state of the problem and restarts the method.
void write_initial_state(Executor& executor, const Problem& problem);

/// Calls visit(first element, fields) for the whole state, 4096 elements at a time.
void for_each_piece(Executor& executor, std::size_t element_count,
                    const std::function<void(std::size_t, std::span<const double>)>& visit);

/// The whole state, 13 numbers per element.
std::vector<double> whole_state(Executor& executor, std::size_t element_count);

/// False if a number is infinite or NaN.
bool all_finite(std::span<const double> numbers);
/// The first element with a number that is not finite, if any.
std::optional<std::size_t> first_not_finite(std::span<const double> state);
std::optional<std::size_t> first_not_finite(Executor& executor, std::size_t element_count);

/// Largest length of a displacement [m].
double max_displacement(std::span<const double> state);
double max_displacement(Executor& executor, std::size_t element_count);

/// The bits of a number that variants agree on. -0 counts as +0. Numbers below 2^-1000 (f64) or
/// 2^-120 (f32) also count as +0, because some variants may flush them (DESIGN.md section 6).
inline std::uint64_t common_bits(double number, Precision precision) {
  const double smallest = precision == Precision::f64 ? 0x1p-1000 : 0x1p-120;
  return std::abs(number) < smallest ? 0 : std::bit_cast<std::uint64_t>(number);
}

/// 64-bit digest of a state's common bits (FNV-1a over 64-bit words).
class StateDigest {
public:
  explicit StateDigest(Precision precision) : precision_(precision) {}
  void add(std::span<const double> fields);
  std::uint64_t value() const { return hash_; }

private:
  Precision precision_;
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// Digest of an executor's state.
std::uint64_t state_digest(Executor& executor, std::size_t element_count, Precision precision);

/// One number for each kind of field: u, q (s, x, y, z), v, w.
using KindValues = std::array<double, 4>;

/// Largest absolute value of each kind in a state.
KindValues largest_of_kinds(std::span<const double> state);

/// Largest difference of each kind; infinite if a number is not finite.
KindValues largest_differences(std::span<const double> expected, std::span<const double> actual);

/// Scale of each kind, by which differences are divided: its largest expected value, but at least
/// 1e-3 of its partner's. Partners are u and q h, and v and w h, with h the shortest edge. A kind
/// that is zero apart from rounding thus gets a sensible scale.
KindValues error_scales(const Problem& problem, const KindValues& largest_expected);

/// A difference divided by its scale; 0 without a difference, infinite if the scale is zero.
inline double relative(double difference, double scale) {
  return difference > 0 ? difference / scale : 0;
}

/// Largest relative error of a state (or of its time derivative) against the expected one: the
/// maximum over the kinds of max|difference| / scale (error_scales). Infinite if a number is not
/// finite.
double state_error(const Problem& problem, std::span<const double> expected,
                   std::span<const double> actual);

/// Largest difference of a displacement component, relative to the largest component.
double displacement_difference(const std::vector<double>& state,
                               const std::vector<double>& reference);

} // namespace dss
