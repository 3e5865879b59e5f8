#pragma once
/// The shared physics as C++. Each model includes the same headers over its own algebra, for a
/// scalar or for a pack of lanes.
#include "kernels/model.hpp"
#include "kernels/simd/simd.hpp"
#include "kernels/stage_row/action_sets.hpp"
#include "kernels/stage_row/row.hpp"
#include "kernels/terms.hpp"

DSS_INLINE_BEGIN
namespace dss {

/// Calls visit(component) for each component of a vec, spin, rotor or element, in the order in
/// which the fields are stored.
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

/// Returns combine(a, b), component by component.
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

// The shared headers have no include guards, because each model includes them with its own algebra.
#define REAL Real
#define FMA(a, b, c) simd::fma(a, b, c)
#define SPLAT(a) Real(a)

/// The physics of a model over numbers of type Real.
template <Model model, class Real>
struct Physics;

/// What a model's physics has besides the shared headers.
template <Model model, class Real>
struct PhysicsTraits {
  using real = Real;
  static constexpr Model of_model = model;
  static constexpr int fields = int(descriptor(model).fields.size()), axes = descriptor(model).axes,
                       vec_size = descriptor(model).vec_size(),
                       spin_size = descriptor(model).spin_size();
  static constexpr bool is_common = descriptor(model).is_common;
};

// The order of the includes matters.
// clang-format off
template <class Real>
struct Physics<Model::spatial, Real> : PhysicsTraits<Model::spatial, Real> {
#include "kernels/algebra/spatial.h"
#define STRESS
#include "kernels/laws.hpp"
};
template <class Real>
struct Physics<Model::small, Real> : PhysicsTraits<Model::small, Real> {
#include "kernels/algebra/small.h"
#include "kernels/laws.hpp"
};
template <class Real>
struct Physics<Model::linear, Real> : PhysicsTraits<Model::linear, Real> {
#include "kernels/algebra/linear.h"
#include "kernels/laws.hpp"
};
template <class Real>
struct Physics<Model::bending, Real> : PhysicsTraits<Model::bending, Real> {
#include "kernels/algebra/bending.h"
#include "kernels/laws.hpp"
};
template <class Real>
struct Physics<Model::membrane, Real> : PhysicsTraits<Model::membrane, Real> {
#include "kernels/algebra/membrane.h"
#include "kernels/laws.hpp"
};
template <class Real>
struct Physics<Model::planar, Real> : PhysicsTraits<Model::planar, Real> {
#include "kernels/algebra/planar.h"
#include "kernels/laws.hpp"
};
template <class Real>
struct Physics<Model::axial, Real> : PhysicsTraits<Model::axial, Real> {
#include "kernels/algebra/axial.h"
#include "kernels/laws.hpp"
};
// clang-format on

#undef REAL
#undef FMA
#undef SPLAT

/// Calls action.operator()<Physics>() with the physics of a model.
template <class Real, class Action>
void with_physics(Model model, Action&& action) {
  for_each_model([&]<Model each>() {
    if (each == model) action.template operator()<Physics<each, Real>>();
  });
}

} // namespace dss
DSS_INLINE_END
