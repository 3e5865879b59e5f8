#pragma once
/// Time integration methods as data. One engine runs them all (variants/engine), the oracle runs them in classical
/// form.
#include <array>
#include <string_view>
#include <vector>

namespace dss {

/// An explicit one-step method with `stages` force evaluations a step.
///
/// Family runge_kutta, in increment form: Y_0 = y_n and, for s = 0 .. stages - 1,
///     Y_{s+1} = y_n + sum_{m=1..s} alpha[s][m] (Y_m - y_n) + h beta[s] f(t_n + node[s] h, Y_s),   y_{n+1} = Y_stages.
/// It needs no running sum, and a state at rest stays at rest to the last bit.
///
/// Family leapfrog (velocity Verlet with one evaluation a step; see solver/numerics/README.md):
///     v_{n+1/2} = v_{n-1/2} + h a(x_n, p_n),  x_{n+1} = x_n + h v_{n+1/2},  p_{n+1} = v_{n+1/2} + (h/2) a(x_n, p_n)
/// where p_n predicts v_n for velocity-dependent terms (damping, gyroscopic), started by v_{-1/2} = v_0 - (h/2) a_0,
/// p_0 = v_0, and read as v_n = v_{n-1/2} + (h/2) a(x_n, p_n). Rotations move by the Cayley map, which keeps |q| = 1.
struct Method {
  static constexpr int max_stages = 4;
  enum class Family { runge_kutta, leapfrog };
  std::string_view name;
  Family family;
  int order;
  int stages;
  std::array<double, max_stages> node;
  std::array<double, max_stages> beta;
  std::array<std::array<double, max_stages>, max_stages> alpha;
  double imaginary_limit; ///< largest stable h |lambda| on the imaginary axis (undamped)
  double real_limit;      ///< largest stable h |lambda| on the negative real axis (0: none by itself)
  std::string_view note;  ///< what a user must know
};

/// All methods; find_method returns nullptr for an unknown name.
const std::vector<Method>& methods();
const Method* find_method(std::string_view name);

} // namespace dss
