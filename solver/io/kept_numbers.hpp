#pragma once
/// Members of an object as a list of numbers, and back. A class lists them once:
///
///     template <class Visit> void each_kept(Visit&& visit) { visit(time_), visit(errors_); }
#include "solver/error.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
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
  /// @throws InputError if too few numbers are left; so do the others
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(Number& value) { value = Number(take(1).front()); }
  template <std::size_t N>
  void operator()(std::array<double, N>& values) {
    std::ranges::copy(take(N), values.begin());
  }
  void operator()(std::vector<double>& values) {
    const double size = take(1).front();
    if (!(size >= 0 && size <= double(from_.size()))) fail();
    const std::span<const double> taken = take(std::size_t(size));
    values.assign(taken.begin(), taken.end());
  }
  bool is_empty() const { return from_.empty(); }

private:
  [[noreturn]] static void fail() { throw InputError("a list of numbers is too short"); }
  std::span<const double> take(std::size_t count) {
    if (count > from_.size()) fail();
    const std::span<const double> taken = from_.first(count);
    from_ = from_.subspan(count);
    return taken;
  }
  std::span<const double> from_;
};

} // namespace dss
