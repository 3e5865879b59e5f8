#pragma once
/// The shared physics as C++: each model is the same headers over its own algebra, instantiated for a scalar or a pack
/// of lanes.
#include "kernels/simd/simd.hpp"

DSS_INLINE_BEGIN
namespace dss {

/// Compile-time switches: a term that is absent is not compiled in (DESIGN.md section 2).
struct Terms {
  bool is_material = false;   ///< material link law, else the paper's
  bool is_damped = false;     ///< velocity-dependent link terms
  bool is_bending = false;    ///< rotational stiffness in the paper's law (the material law always has it)
  bool is_gyroscopic = false; ///< tensor inertia
  bool is_tied = false;       ///< stabilization
  bool is_oblong = false;     ///< the model's edges differ (paper's law: a square's or cube's faces share constants)
  constexpr bool has_couples() const { return is_material || is_damped || is_bending; }
  /// Forces depend on velocities: leapfrog then carries a prediction of them.
  constexpr bool is_velocity_dependent() const { return is_damped || is_gyroscopic || is_tied; }
  constexpr bool operator==(const Terms&) const = default;
  constexpr bool covers(const Terms& need) const {
    return is_material == need.is_material && is_damped >= need.is_damped &&
           (is_material || is_bending >= need.is_bending) && is_gyroscopic >= need.is_gyroscopic &&
           is_tied >= need.is_tied && (is_material || is_oblong >= need.is_oblong);
  }
};

// The shared headers have no include guards: each model includes them with its own algebra.
#define REAL Real
#define FMA(a, b, c) simd::fma(a, b, c)
#define SPLAT(a) Real(a)

template <class Real>
struct SpatialPhysics {
  using real = Real;
  static constexpr int fields = 13;
  // The order counts.
  // clang-format off
#include "kernels/algebra/spatial.h"
#include "kernels/link_force/link_force.h"
#include "kernels/motion/motion.h"
#include "kernels/wrench/wrench.h"
#include "kernels/rk_update/rk_update.h"
#include "kernels/stress/stress.h"
#include "kernels/cases.h"
  // clang-format on
};

template <class Real>
struct PlanarPhysics {
  using real = Real;
  static constexpr int fields = 7;
#define PLANAR
  // The order counts.
  // clang-format off
#include "kernels/algebra/planar.h"
#include "kernels/link_force/link_force.h"
#include "kernels/motion/motion.h"
#include "kernels/wrench/wrench.h"
#include "kernels/rk_update/rk_update.h"
#include "kernels/cases.h"
  // clang-format on
#undef PLANAR
};

#undef REAL
#undef FMA
#undef SPLAT

/// Calls visit(component) for each component of a vec, spin, rotor or element, in the order in which fields are stored.
template <class Tuple, class Visit>
constexpr void each_component(Tuple& t, Visit&& visit) {
  if constexpr (requires { t.u; }) {
    each_component(t.u, visit);
    each_component(t.v, visit);
    each_component(t.q, visit);
    each_component(t.w, visit);
  } else {
    if constexpr (requires { t.s; }) visit(t.s);
    if constexpr (requires { t.x; }) visit(t.x);
    if constexpr (requires { t.y; }) visit(t.y);
    if constexpr (requires { t.z; }) visit(t.z);
  }
}

template <class Tuple>
constexpr int component_count() {
  Tuple t{};
  int n = 0;
  each_component(t, [&](auto&) { ++n; });
  return n;
}

/// Component by component combine(a, b).
template <class Tuple, class Combine>
inline Tuple each_pair(const Tuple& a, const Tuple& b, Combine&& combine) {
  Tuple r;
  if constexpr (requires { a.u; }) {
    r.u = each_pair(a.u, b.u, combine);
    r.v = each_pair(a.v, b.v, combine);
    r.q = each_pair(a.q, b.q, combine);
    r.w = each_pair(a.w, b.w, combine);
  } else {
    if constexpr (requires { a.s; }) r.s = combine(a.s, b.s);
    if constexpr (requires { a.x; }) r.x = combine(a.x, b.x);
    if constexpr (requires { a.y; }) r.y = combine(a.y, b.y);
    if constexpr (requires { a.z; }) r.z = combine(a.z, b.z);
  }
  return r;
}

} // namespace dss
DSS_INLINE_END
