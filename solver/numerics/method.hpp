#pragma once
/// Time integration methods as data. One engine runs all of them (variants/engine); the oracle runs
/// them in classical form.
#include "solver/numerics/signal_polynomial.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// A one-step method with `stages` force evaluations a step (implicit: in each iteration).
/// README.md explains the families.
///
/// Family runge_kutta, in increment form: Y_0 = y_n and, for s = 0 .. stages - 1,
///     Y_{s+1} = y_n + sum_{m=1..s} alpha[s][m] (Y_m - y_n) + h beta[s] f(t_n + node[s] h, Y_s)
///     y_{n+1} = Y_stages
/// It needs no running sum, and a state at rest stays at rest to the last bit. With an error stage,
/// y_{n+1} is the input of the last stage. That stage computes E = Y_stages - y_n, the estimate of
/// the step's error.
///
/// Family leapfrog, one evaluation a step, s = smoothing:
///     v_{n+1/2} = v_{n-1/2} + h a(x_n, p_n),   x_{n+1} = x_n + h v_{n+1/2}
///     p_{n+1}   = v_{n+1/2} + s (p_n - v_{n-1/2}) + (1 - s)/2 h a(x_n, p_n)
/// p_n predicts v_n for terms that depend on velocity (damping, gyroscopic). It starts with
/// v_{-1/2} = v_0 - (h/2) a_0 and p_0 = v_0. Callers read v_n = v_{n-1/2} + (h/2) a(x_n, p_n).
/// Rotations move by the Cayley map, which keeps |q| = 1.
///
/// Family symplectic_euler, with the same Cayley map:
///     v_{n+1} = v_n + h a(x_n, v_n),   x_{n+1} = x_n + h v_{n+1}
///
/// Family implicit_midpoint: y_{n+1} = y_n + h f(t_n + h/2, (y_n + y_{n+1}) / 2).
///
/// Family diagonally_implicit, Runge-Kutta methods whose stages depend on themselves and on earlier
/// ones, all implicit stages with the same beta:
///     Y_s = y_n + h sum_{m<s} alpha[s][m] k_m + h beta[s] k_s,   k_s = f(t_n + node[s] h, Y_s)
///     y_{n+1} = Y_{stages-1}
/// A first stage with beta = 0 takes k_0 from the last stage of the step before.
///
/// Family generalized_alpha, with a rate r_n that the method keeps (r_0 = f(t_0, y_0)), c =
/// node[1], a = rate_share and g = 1/2 + a - c:
///     y_{n+1} = y_n + h ((1 - g) r_n + g r_{n+1})
///     (1 - a) r_n + a r_{n+1} = f(t_n + c h, y_n + c (y_{n+1} - y_n))
///
/// Family leaps, for undamped linear problems: the exact solution for loads that are polynomials of
/// degree 4 in each step (leap_weights.hpp). All steps of a call are one leap. It is a sum
/// over the states of a method in place, whose steps are of the problem's fastest motion.
struct Method {
  enum class Family {
    runge_kutta,
    leapfrog,
    symplectic_euler,
    implicit_midpoint,
    diagonally_implicit,
    generalized_alpha,
    leaps
  };
  std::string_view name;
  Family family;
  int order;
  int stages;
  std::vector<double> node; ///< one for each stage
  std::vector<double> beta; ///< one for each stage
  /// One row for each stage. runge_kutta: row s has s + 1 numbers; the first is not used.
  /// diagonally_implicit: s numbers.
  std::vector<std::vector<double>> alpha;
  /// Largest stable h |lambda| on the imaginary axis (undamped); infinite for implicit and
  /// exponential ones.
  double imaginary_limit;
  double real_limit;  ///< largest stable h |lambda| on the negative real axis
  bool is_symplectic; ///< a step of an undamped linear problem is a symplectic map
  /// The energy of an undamped problem without gyroscopic terms has no trend over any number of
  /// steps.
  bool keeps_energy_bounded;
  std::string_view note; ///< a warning or hint for users
  /// Steps are tried first, then accepted or rejected (step_control.hpp).
  bool has_error_stage = false;
  double smoothing = 0; ///< leapfrog: share of the last correction that a prediction keeps, below 1
  double rate_share = 0; ///< generalized_alpha: a
  /// For linear models: exact to rounding if loads are polynomials of degree 4 in each step.
  bool is_exponential = false;
  /// Not empty: the signals of stage s are sums of those at five points of the step
  /// (signal_polynomial.hpp) with the weights signal_weights[s], and not those at its node.
  std::vector<std::array<double, signal_points>> signal_weights{};

  bool is_implicit() const {
    return family == Family::implicit_midpoint || family == Family::diagonally_implicit ||
           family == Family::generalized_alpha;
  }
  bool has_leaps() const { return family == Family::leaps; }
  /// Made for a problem and a step (`fitted` in stability.hpp).
  bool is_fitted() const { return name == "rkc2" || (is_exponential && !has_leaps()); }
  /// Every step is stable.
  bool is_unlimited() const { return is_implicit() || is_exponential; }
  /// generalized_alpha: g.
  double rate_weight() const { return 0.5 + rate_share - node[1]; }
  /// Velocities live half a step before positions.
  bool is_staggered() const { return family == Family::leapfrog; }
  /// Explicit with one stage. Updates velocities, then positions from the new velocities.
  bool is_in_place() const {
    return family == Family::leapfrog || family == Family::symplectic_euler;
  }
};

/// Runge-Kutta-Chebyshev method of second order with two or more stages, for problems that damping
/// makes stiff. Its limit on the negative real axis is about 0.65 (s^2 - 1) for s stages. Source:
/// B. P. Sommeijer, L. F. Shampine, J. G. Verwer, J. Comput. Appl. Math. 88 (1998) 315-326, eq.
/// (2.7), (2.8).
Method rkc2(int stages);

/// The generalized-alpha method for equations of first order, with the amplification `radius` (0 to
/// 1) of the fastest undamped modes in a step. Source: K. E. Jansen, C. H. Whiting, G. M. Hulbert,
/// Comput. Methods Appl. Mech. Engrg. 190 (2000) 305-319.
Method generalized_alpha(double radius);

/// The method dopri5 with an error stage, for adaptive steps. E is the difference between the
/// results of fifth and fourth order.
const Method& dopri5_adaptive();

/// All explicit methods. Every variant has them. rkc2 is listed with five stages.
const std::vector<Method>& methods();
/// Methods that solve equations in every step. The variants `reference` and `sparse` have them.
/// generalized_alpha is listed with the radius 0.8.
const std::vector<Method>& implicit_methods();
/// Methods of linear models (is_exponential). `faber` has no stages before it is `fitted`.
const std::vector<Method>& exponential_methods();
/// Explicit methods, then implicit methods; not the exponential ones.
std::vector<const Method*> all_methods();
/// Names of all methods, in the order of all_methods(), then exponential_methods().
std::vector<std::string> method_names();
/// The part of a step that an implicit stage spans: Y = base + this h f(Y). All implicit stages of
/// a method have the same.
double implicit_share(const Method& method);
/// Finds a method of any list; nullptr if the name is unknown. `generalized_alpha:R` is
/// that method with the radius R, and has that name.
const Method* find_method(std::string_view name);
/// What names with a radius begin with.
inline constexpr std::string_view with_radius = "generalized_alpha:";
/// Why find_method finds nothing, and what would be right; empty if it finds a method.
std::string why_no_method(std::string_view name);

} // namespace dss
