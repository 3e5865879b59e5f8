#include "solver/reference/implicit_midpoint.hpp"

#include "solver/reference/colouring.hpp"
#include "solver/reference/real_types.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss::reference {
namespace {

constexpr int unknowns = 6; ///< of an element: v, then w
constexpr int most_iterations = 40;
/// New factors pay off if a correction is more than this fraction of the previous one.
constexpr double slow = 0.1;

/// Field of the unknown number d of an element.
std::size_t field_of(int d) { return std::size_t(d < 3 ? vx + d : wx + d - 3); }
Eigen::Index place_of(std::size_t e, int d) { return Eigen::Index(e) * unknowns + d; }

template <class T>
T length(const T* three) {
  return std::hypot(three[0], three[1], three[2]);
}

} // namespace

template <class T>
ImplicitMidpoint<T>::ImplicitMidpoint(const Problem& problem, double dt)
    : dt_(T(dt)), neighbourhoods_(neighbourhoods(problem)), groups_(colour_groups(neighbourhoods_)),
      mid_(problem.lattice.element_count * field_count), rates_(mid_.size()),
      disturbed_rates_(mid_.size()) {
  problem.lattice.for_each_element([&](std::size_t, const Row& row, int) {
    const Body& body = problem.bodies[std::size_t(row.body)];
    gyration_.push_back(
        T(std::sqrt((body.inertia[0] + body.inertia[1] + body.inertia[2]) / (3 * body.mass))));
    edge_.push_back(T(std::max({body.edge[0], body.edge[1], body.edge[2]})));
  });
  restart();
}

template <class T>
void ImplicitMidpoint<T>::restart() {
  change_ = Unknowns::Zero(place_of(gyration_.size(), 0));
  has_factors_ = false;
  factorisations_ = 0;
}

template <class T>
std::optional<std::size_t> ImplicitMidpoint<T>::solve_or_worst(Dynamics<T>& dynamics,
                                                               std::span<const T> state,
                                                               std::span<const double> signals) {
  if (solve(dynamics, state, signals)) return std::nullopt;
  // The change of the last step may be too far off as a first guess. No better guess is known than
  // zero.
  restart();
  if (solve(dynamics, state, signals)) return std::nullopt;
  return worst_element();
}

template <class T>
std::optional<std::size_t> ImplicitMidpoint<T>::step(Dynamics<T>& dynamics, std::span<T> state,
                                                     std::span<const double> signals) {
  if (const auto worst = solve_or_worst(dynamics, state, signals)) return worst;
  finish(dynamics, state);
  return std::nullopt;
}

template <class T>
std::optional<std::size_t> ImplicitMidpoint<T>::stage(Dynamics<T>& dynamics,
                                                      std::span<const T> base,
                                                      std::span<const double> signals,
                                                      std::span<T> reached, std::span<T> slope) {
  if (const auto worst = solve_or_worst(dynamics, base, signals)) return worst;
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    place_middle(dynamics, base, e);
    const T* mid = mid_.data() + e * field_count;
    T* rates = slope.data() + e * field_count;
    for (int axis = 0; axis < 3; ++axis) rates[ux + axis] = mid[vx + axis];
    for (int d = 0; d < unknowns; ++d) rates[field_of(d)] = change_[place_of(e, d)] / dt_;
    set_orientation_fields(
        rates, dynamics.coordinates().rate(orientation_fields(mid), {mid[wx], mid[wy], mid[wz]}));
  }
  std::ranges::copy(mid_, reached.begin());
  return std::nullopt;
}

/// Newton's iteration from change_. Stops when corrections are below rounding, or when they no
/// longer fall and are at the rounding of the forces.
template <class T>
bool ImplicitMidpoint<T>::solve(Dynamics<T>& dynamics, std::span<const T> state,
                                std::span<const double> signals) {
  constexpr T epsilon = std::numeric_limits<T>::epsilon();
  const T noise = T(100) * epsilon * speed_from_rounding(state);
  T last = std::numeric_limits<T>::infinity();
  bool are_factors_new = false;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    find_residual(dynamics, state, signals);
    if (!has_factors_) {
      if (!find_jacobian(dynamics, state, signals)) return false;
      are_factors_new = true;
    }
    const Unknowns step = correction();
    const T size = speed(step);
    if (!std::isfinite(size)) return false;
    change_ -= step;
    const T ratio = size / last, scale = speed(change_);
    if (size <= epsilon * scale) return true;
    if (iteration > 0) {
      // The error after a correction is about ratio / (1 - ratio) times the correction.
      if (ratio < T(0.5) && ratio / (T(1) - ratio) * size <= epsilon / T(4) * scale) return true;
      if (ratio > T(0.5) && size <= std::max(noise, T(10) * epsilon * scale)) return true;
      if (ratio > T(slow) && !are_factors_new) has_factors_ = false;
    }
    are_factors_new = false;
    last = size;
  }
  return false;
}

/// Fields of an element in the middle of the step, from change_.
template <class T>
void ImplicitMidpoint<T>::place_middle(const Dynamics<T>& dynamics, std::span<const T> state,
                                       std::size_t e) {
  const T* y = state.data() + e * field_count;
  T* mid = mid_.data() + e * field_count;
  for (int d = 0; d < unknowns; ++d)
    mid[field_of(d)] = y[field_of(d)] + change_[place_of(e, d)] / T(2);
  for (int axis = 0; axis < 3; ++axis) mid[ux + axis] = y[ux + axis] + dt_ / T(2) * mid[vx + axis];
  const Vector<T> w = {mid[wx], mid[wy], mid[wz]};
  set_orientation_fields(mid, dynamics.coordinates().midpoint(orientation_fields(y), w, dt_));
}

template <class T>
void ImplicitMidpoint<T>::find_residual(Dynamics<T>& dynamics, std::span<const T> state,
                                        std::span<const double> signals) {
  for (std::size_t e = 0; e < gyration_.size(); ++e) place_middle(dynamics, state, e);
  dynamics.rates(mid_, signals, rates_);
  residual_.resize(change_.size());
  for (std::size_t e = 0; e < gyration_.size(); ++e)
    for (int d = 0; d < unknowns; ++d)
      residual_[place_of(e, d)] =
          change_[place_of(e, d)] - dt_ * rates_[e * field_count + field_of(d)];
}

/// Factors of the derivative of the residual by change_, at the state of rates_. The disturbances
/// move and turn elements, in the middle of the step, by the square root of rounding of an edge and
/// of a radian.
template <class T>
bool ImplicitMidpoint<T>::find_jacobian(Dynamics<T>& dynamics, std::span<const T> state,
                                        std::span<const double> signals) {
  const T turn = T(4) * std::sqrt(std::numeric_limits<T>::epsilon()) / dt_;
  std::vector<Eigen::Triplet<double>> entries;
  const auto disturb = [&](const std::vector<std::size_t>& group, int d, T sign) {
    for (const std::size_t e : group) {
      change_[place_of(e, d)] += sign * turn * (d < 3 ? edge_[e] : T(1));
      place_middle(dynamics, state, e);
    }
  };
  const Unknowns undisturbed = change_;
  for (const std::vector<std::size_t>& group : groups_)
    for (int d = 0; d < unknowns; ++d) {
      disturb(group, d, T(1));
      dynamics.rates(mid_, signals, disturbed_rates_);
      for (const std::size_t e : group) {
        const T by = change_[place_of(e, d)] - undisturbed[place_of(e, d)];
        for (const std::size_t felt : neighbourhoods_[e])
          for (int r = 0; r < unknowns; ++r) {
            const std::size_t at = felt * field_count + field_of(r);
            const T slope = T(felt == e && r == d) - dt_ * (disturbed_rates_[at] - rates_[at]) / by;
            if (slope != T(0))
              entries.emplace_back(int(place_of(felt, r)), int(place_of(e, d)), double(slope));
          }
        change_[place_of(e, d)] = undisturbed[place_of(e, d)];
        place_middle(dynamics, state, e);
      }
    }
  if (std::ranges::any_of(entries, [](const auto& entry) { return !std::isfinite(entry.value()); }))
    return false;
  Eigen::SparseMatrix<double> jacobian(change_.size(), change_.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  factors_.compute(jacobian);
  ++factorisations_;
  return has_factors_ = factors_.info() == Eigen::Success;
}

template <class T>
auto ImplicitMidpoint<T>::correction() const -> Unknowns {
  const Eigen::VectorXd residual = residual_.template cast<double>();
  return factors_.solve(residual).template cast<T>();
}

/// Largest velocity among changes [m/s]. Angular velocities count at the radius of gyration.
template <class T>
T ImplicitMidpoint<T>::speed(const Unknowns& changes) const {
  T largest = 0;
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    const T* own = changes.data() + place_of(e, 0);
    const T of_element = std::max(length(own), gyration_[e] * length(own + 3));
    if (!(of_element <= largest)) largest = of_element; // also if of_element is NaN
  }
  return largest;
}

/// Velocity [m/s] that corresponds to rounding of displacements, turns and velocities by one whole
/// unit. Forces are differences of such numbers.
template <class T>
T ImplicitMidpoint<T>::speed_from_rounding(std::span<const T> state) const {
  T largest = 0;
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    const T* y = state.data() + e * field_count;
    const T moved = length(y + ux) + edge_[e] * std::hypot(y[qs], length(y + qx));
    largest = std::max({largest, length(y + vx), gyration_[e] * length(y + wx), moved / dt_});
  }
  return largest;
}

template <class T>
std::size_t ImplicitMidpoint<T>::worst_element() const {
  std::size_t worst = 0;
  T largest = -1;
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    const T* own = residual_.data() + place_of(e, 0);
    const T size = std::max(length(own), gyration_[e] * length(own + 3));
    if (!std::isfinite(size)) return e;
    if (size > largest) largest = size, worst = e;
  }
  return worst;
}

/// y_{n+1} from the solution, change_.
template <class T>
void ImplicitMidpoint<T>::finish(const Dynamics<T>& dynamics, std::span<T> state) const {
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    T* y = state.data() + e * field_count;
    const Vector<T> half = {change_[place_of(e, 3)] / T(2), change_[place_of(e, 4)] / T(2),
                            change_[place_of(e, 5)] / T(2)};
    const Vector<T> w = Vector<T>{y[wx], y[wy], y[wz]} + half;
    set_orientation_fields(y, dynamics.coordinates().midpoint_end(orientation_fields(y), w, dt_));
    for (int axis = 0; axis < 3; ++axis) {
      y[ux + axis] += dt_ * (y[vx + axis] + change_[place_of(e, axis)] / T(2));
      y[vx + axis] += change_[place_of(e, axis)];
      y[wx + axis] += change_[place_of(e, 3 + axis)];
    }
  }
}

template <class T>
std::size_t ImplicitMidpoint<T>::bytes() const {
  std::size_t links = 0;
  for (const auto& near : neighbourhoods_) links += near.size();
  const auto numbers = std::size_t(2 * change_.size()) + 3 * mid_.size() + 2 * gyration_.size();
  const auto of_factors = has_factors_ ? std::size_t(factors_.nnzL() + factors_.nnzU()) : 0;
  return numbers * sizeof(T) + links * sizeof(std::size_t) +
         of_factors * (sizeof(double) + sizeof(int));
}

#define DSS_INSTANTIATE(T) template class ImplicitMidpoint<T>;
DSS_EACH_REAL(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::reference
