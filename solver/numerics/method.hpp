#pragma once
/// Time integration methods as data. One engine runs them all (variants/engine), the oracle runs them in classical
/// form.
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// A one-step method with `stages` force evaluations a step (of implicit_midpoint: in each iteration).
///
/// Family runge_kutta, in increment form: Y_0 = y_n and, for s = 0 .. stages - 1,
///     Y_{s+1} = y_n + sum_{m=1..s} alpha[s][m] (Y_m - y_n) + h beta[s] f(t_n + node[s] h, Y_s),   y_{n+1} = Y_stages.
/// It needs no running sum, and a state at rest stays at rest to the last bit. With an error stage, y_{n+1} is the input of the last stage,
/// which leaves E = Y_stages - y_n, the estimate of the step's error.
///
/// Family leapfrog, with one evaluation a step (see solver/numerics/README.md), s = smoothing:
///     v_{n+1/2} = v_{n-1/2} + h a(x_n, p_n),  x_{n+1} = x_n + h v_{n+1/2},
///     p_{n+1} = v_{n+1/2} + s (p_n - v_{n-1/2}) + (1 - s)/2 h a(x_n, p_n)
/// where p_n predicts v_n for velocity-dependent terms (damping, gyroscopic), started by v_{-1/2} = v_0 - (h/2) a_0,
/// p_0 = v_0, and read as v_n = v_{n-1/2} + (h/2) a(x_n, p_n). Rotations move by the Cayley map, which keeps |q| = 1.
///
/// Family symplectic_euler: v_{n+1} = v_n + h a(x_n, v_n),  x_{n+1} = x_n + h v_{n+1}, with the same Cayley map.
///
/// Family implicit_midpoint: y_{n+1} = y_n + h f(t_n + h/2, (y_n + y_{n+1}) / 2).
struct Method {
  enum class Family { runge_kutta, leapfrog, symplectic_euler, implicit_midpoint };
  std::string_view name;
  Family family;
  int order;
  int stages;
  std::vector<double> node;               ///< stages
  std::vector<double> beta;               ///< stages
  std::vector<std::vector<double>> alpha; ///< stages rows, row s of s + 1 numbers of which the first means nothing
  double imaginary_limit; ///< largest stable h |lambda| on the imaginary axis (undamped); infinite for implicit ones
  double real_limit;      ///< largest stable h |lambda| on the negative real axis
  bool is_symplectic;     ///< its steps of an undamped problem are a symplectic map
  bool
      keeps_energy_bounded; ///< the energy of an undamped problem without gyroscopic terms has no trend, however many steps
  std::string_view note;        ///< what a user must know
  bool has_error_stage = false; ///< for steps that are tried first, and accepted or not (step_control.hpp)
  double smoothing = 0;         ///< leapfrog: what a prediction keeps of the correction before it, below 1

  bool is_implicit() const { return family == Family::implicit_midpoint; }
  /// Velocities live half a step before positions.
  bool is_staggered() const { return family == Family::leapfrog; }
  /// Explicit, of one stage, which updates velocities and then positions by them.
  bool is_in_place() const { return family == Family::leapfrog || family == Family::symplectic_euler; }
};

/// Runge-Kutta-Chebyshev of second order with 2 stages or more, for problems that damping makes stiff: its limit on the negative real axis
/// is about 0.65 (s^2 - 1). B. P. Sommeijer, L. F. Shampine, J. G. Verwer, J. Comput. Appl. Math. 88 (1998) 315-326, eq. (2.7), (2.8).
Method rkc2(int stages);

/// The method dopri5 with an error stage, for adaptive steps: E is the difference between the results of fifth and fourth order.
const Method& dopri5_adaptive();

/// All explicit methods: every variant has them. Of rkc2 there is one with five stages.
const std::vector<Method>& methods();
/// Methods that solve equations in every step: of the variant `reference` alone.
const std::vector<Method>& implicit_methods();
/// Of either kind, in this order.
std::vector<const Method*> all_methods();
std::vector<std::string> method_names();
/// Of either kind; nullptr for an unknown name.
const Method* find_method(std::string_view name);

} // namespace dss
