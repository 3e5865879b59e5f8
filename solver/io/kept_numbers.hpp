#pragma once
/// Members of an object as a list of numbers, and back. A class lists them once:
///
///     template <class Visit> void each_kept(Visit&& visit) { visit(time_), visit(errors_); }
#include "solver/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace dss {

/// Appends each visited member. Whole numbers are exact up to 2^53.
class PutNumbers {
public:
  explicit PutNumbers(std::vector<double>& to) : to_(to) {}
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(const Number& value) { to_.push_back(double(value)); }
  template <std::size_t N>
  void operator()(const std::array<double, N>& values) {
    to_.insert(to_.end(), values.begin(), values.end());
  }
  void operator()(const std::vector<double>& values) {
    to_.push_back(double(values.size()));
    to_.insert(to_.end(), values.begin(), values.end());
  }

private:
  std::vector<double>& to_;
};

/// Sets each visited member.
class TakeNumbers {
public:
  explicit TakeNumbers(std::span<const double> from) : from_(from) {}
  /// @throws InputError if no number is left, or if it is not one of the member's type
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(Number& value) {
    const double given = take(1).front();
    if constexpr (std::is_integral_v<Number>) {
      constexpr double exact = 0x1p53,
                       largest = std::min(exact, double(std::numeric_limits<Number>::max()));
      if (!(given >= 0 && given <= largest && given == std::floor(given)))
        throw InputError("a whole number is out of range");
    }
    value = Number(given);
  }
  template <std::size_t N>
  void operator()(std::array<double, N>& values) {
    std::ranges::copy(take(N), values.begin());
  }
  /// @throws InputError if the list has another size than the member
  void operator()(std::vector<double>& values) {
    if (take(1).front() != double(values.size())) throw InputError("a list has another size");
    std::ranges::copy(take(values.size()), values.begin());
  }
  bool is_empty() const { return from_.empty(); }

private:
  std::span<const double> take(std::size_t count) {
    if (count > from_.size()) throw InputError("a list of numbers is too short");
    const std::span<const double> taken = from_.first(count);
    from_ = from_.subspan(count);
    return taken;
  }
  std::span<const double> from_;
};

} // namespace dss
