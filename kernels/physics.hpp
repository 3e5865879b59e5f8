#pragma once
/// The shared physics as C++: each model is the same headers over its own algebra, instantiated for a scalar or a pack
/// of lanes.
#include "kernels/simd/simd.hpp"
#include "solver/model/model.hpp"

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

// Of each: numbers of an element; axes along which elements are linked; is_common: many runs take it, so that it is worth the compiler's time.

template <class Real>
struct SpatialPhysics {
  using real = Real;
  static constexpr int fields = 13, axes = 3;
  static constexpr bool is_common = true;
#define AXES 3
  // clang-format off
#include "kernels/algebra/spatial.h"
#include "kernels/laws.h"
#define STRESS
#include "kernels/stress/stress.h"
#include "kernels/cases.h"
#undef STRESS
  // clang-format on
#undef AXES
};

template <class Real>
struct SmallPhysics {
  using real = Real;
  static constexpr int fields = 12, axes = 3;
  static constexpr bool is_common = false;
#define AXES 3
  // clang-format off
#include "kernels/algebra/small.h"
#include "kernels/laws.h"
#include "kernels/cases.h"
  // clang-format on
#undef AXES
};

template <class Real>
struct LinearPhysics {
  using real = Real;
  static constexpr int fields = 12, axes = 3;
  static constexpr bool is_common = false;
#define AXES 3
#define LINEAR
  // clang-format off
#include "kernels/algebra/linear.h"
#include "kernels/laws.h"
#include "kernels/cases.h"
  // clang-format on
#undef LINEAR
#undef AXES
};

template <class Real>
struct BendingPhysics {
  using real = Real;
  static constexpr int fields = 6, axes = 2;
  static constexpr bool is_common = false;
#define AXES 2
#define LINEAR
  // clang-format off
#include "kernels/algebra/bending.h"
#include "kernels/laws.h"
#include "kernels/cases.h"
  // clang-format on
#undef LINEAR
#undef AXES
};

template <class Real>
struct MembranePhysics {
  using real = Real;
  static constexpr int fields = 6, axes = 2;
  static constexpr bool is_common = true;
#define AXES 2
#define PLANAR
#define LINEAR
  // clang-format off
#include "kernels/algebra/membrane.h"
#include "kernels/laws.h"
#include "kernels/cases.h"
  // clang-format on
#undef LINEAR
#undef PLANAR
#undef AXES
};

template <class Real>
struct PlanarPhysics {
  using real = Real;
  static constexpr int fields = 7, axes = 2;
  static constexpr bool is_common = true;
#define AXES 2
#define PLANAR
  // clang-format off
#include "kernels/algebra/planar.h"
#include "kernels/laws.h"
#include "kernels/cases.h"
  // clang-format on
#undef PLANAR
#undef AXES
};

template <class Real>
struct AxialPhysics {
  using real = Real;
  static constexpr int fields = 2, axes = 1;
  static constexpr bool is_common = false;
#define AXES 1
#define LINEAR
  // clang-format off
#include "kernels/algebra/axial.h"
#include "kernels/laws.h"
  // clang-format on
#undef LINEAR
#undef AXES
};

#undef REAL
#undef FMA
#undef SPLAT

/// action.operator()<Physics>() with the physics of a model.
template <class Real, class Action>
auto with_physics(Model model, Action&& action) {
  switch (model) {
  case Model::small:
    return action.template operator()<SmallPhysics<Real>>();
  case Model::linear:
    return action.template operator()<LinearPhysics<Real>>();
  case Model::bending:
    return action.template operator()<BendingPhysics<Real>>();
  case Model::membrane:
    return action.template operator()<MembranePhysics<Real>>();
  case Model::planar:
    return action.template operator()<PlanarPhysics<Real>>();
  case Model::axial:
    return action.template operator()<AxialPhysics<Real>>();
  case Model::spatial:
    break;
  }
  return action.template operator()<SpatialPhysics<Real>>();
}

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
  Tuple r{};
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
