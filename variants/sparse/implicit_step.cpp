#include "variants/sparse/implicit_step.hpp"

#include <utility>

namespace dss {

/// Makes the kept slope that of the present state, unless the last step did so.
void ImplicitStep::start(const Vector& state, std::span<const double> signals) {
  if (!has_slope_) stages_.find_slope(state, row(signals, 0), slopes_.back());
  has_slope_ = true;
}

std::optional<std::size_t> ImplicitStep::diagonally_implicit_step(Vector& state,
                                                                  std::span<const double> signals) {
  const bool is_first_explicit = method_.beta[0] == 0;
  if (is_first_explicit) {
    start(state, signals);
    slopes_.front() = slopes_.back();
  }
  for (std::size_t s = is_first_explicit ? 1 : 0; s < slopes_.size(); ++s) {
    base_ = state;
    for (std::size_t m = 0; m < s; ++m) base_ += dt_ * method_.alpha[s][m] * slopes_[m];
    if (const auto element = stages_.solve(base_, row(signals, s), slopes_[s])) return element;
  }
  state = base_ + share_ * slopes_.back();
  return std::nullopt;
}

std::optional<std::size_t> ImplicitStep::generalized_alpha_step(Vector& state,
                                                                std::span<const double> signals) {
  const double node = method_.node[1], a = method_.rate_share, g = method_.rate_weight();
  start(state, signals);
  Vector &kept = slopes_.back(), &next = slopes_.front();
  base_ = state + node * dt_ * (1 - g - g * (1 - a) / a) * kept;
  if (const auto element = stages_.solve(base_, row(signals, 1), next)) return element;
  next = (next - (1 - a) * kept) / a;
  state += dt_ * ((1 - g) * kept + g * next);
  std::swap(kept, next);
  return std::nullopt;
}

std::optional<std::size_t> ImplicitStep::midpoint_step(Vector& state,
                                                       std::span<const double> signals) {
  if (const auto element = stages_.solve(state, signals, slopes_.front())) return element;
  state += dt_ * slopes_.front();
  return std::nullopt;
}

std::optional<std::size_t> ImplicitStep::advance(Vector& state, std::span<const double> signals) {
  const auto failed = method_.family == Method::Family::diagonally_implicit
                          ? diagonally_implicit_step(state, signals)
                      : method_.family == Method::Family::generalized_alpha
                          ? generalized_alpha_step(state, signals)
                          : midpoint_step(state, signals);
  if (failed) restart();
  return failed;
}

} // namespace dss
