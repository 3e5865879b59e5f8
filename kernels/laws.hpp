/// The rest of a model's physics in C++, after its algebra (physics.hpp). It ends the algebra, so
/// that the next model can begin. No include guard: each model includes it. The order of the
/// includes matters. The axial model has no cases.
// clang-format off
#include "kernels/laws.h"
#ifdef STRESS
#include "kernels/stress/stress.h"
#endif
#if AXES > 1
#include "kernels/case_functions.h"
#endif
// clang-format on

/// The update of rows. W: numbers from a component of a pack to the next. fixed_action: the action
/// of all rows, or a set of actions (stage_row/action_sets.hpp).
template <class T, int W, int fixed_action>
struct Update {
#define NUMBER T
#define GLOBAL
#define LOAD(p) simd::load(p)
#define STORE(v, p) simd::store(p, v)
#define STORE_EARLY(v, p) STORE(v, p)
#define STORE_LATE(v, p) (void)0
#define EACH_OF_VEC(act, t)                                                                        \
  each_component(t, [&]([[maybe_unused]] REAL& component) { act(component) });
#define EACH_OF_SPIN(act, t) EACH_OF_VEC(act, t)
#define EACH_OF_ROTOR(act, t) EACH_OF_VEC(act, t)
#define VEC_SIZE Physics::vec_size
#define SPIN_SIZE Physics::spin_size
#define FIELDS Physics::fields
#define ROW const RowTask<T>*
#define TASK(row) (row)
#define PLACE(row, p) (p)
#define IF_ACTION(k, which)                                                                        \
  if constexpr (has_action<T>(fixed_action, which))                                                \
    if (fixed_action == (which) || (k).action == (which))
#include "kernels/algebra/memory.h"
#include "kernels/rk_update/row_update.h"
#undef NUMBER
#undef GLOBAL
#undef LOAD
#undef STORE
#undef STORE_EARLY
#undef STORE_LATE
#undef EACH_OF_VEC
#undef EACH_OF_SPIN
#undef EACH_OF_ROTOR
#undef VEC_SIZE
#undef SPIN_SIZE
#undef FIELDS
#undef ROW
#undef TASK
#undef PLACE
#undef IF_ACTION
#undef V_AT
#undef Q_AT
#undef W_AT
#undef V_HALF_AT
#undef W_HALF_AT
};
#include "kernels/algebra/end.h"
