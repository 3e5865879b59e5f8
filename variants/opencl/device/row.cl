/* One stage of one row, for one combination of terms. The host defines FLAGS (the terms) and
 * NAME(f), which is f_<number of the combination>. The loop over packs is in row_of_vectors.cl or
 * row_of_items.cl; this file has what both share. `d` holds the tables of the device.
 *
 * If elements have a pressure, the host also defines HAS_PRESSURE and IS_BENT (it has moments), and
 * for the parts that rows store PRESSURE_SIZE and COMPONENTS_OF_PRESSURE(act)
 * (kernels/stage_row/element_pressure.hpp). */

static inline paper_law NAME(paper_law_of)(global const body_constants* body, int axis) {
  if (!FLAGS.is_oblong) axis = 0;
  paper_law law = {SPLAT(body->edge[axis]), SPLAT(body->half_edge[axis]), SPLAT(body->tau),
                   SPLAT(body->kt2), SPLAT(body->dt)};
  return law;
}
/* Law of a pack's links along an axis. is_below: those across the lower faces. */
static inline axis_law NAME(law_of)(device d, global const row_stage* task, const int pack,
                                    const int axis, const int is_below) {
  global const body_constants* body = d.bodies + task->body;
#if HAS_LINK_KINDS
  global const link_lanes* links =
      d.links + d.link_index[6 * (task->masks + pack) + 3 * is_below + axis];
#define OF_LINK(c) LOAD(links->c.lane + LANE)
#else
#define OF_LINK(c) SPLAT(body->axis[axis].c)
#endif
  const REAL edge = SPLAT(body->edge[axis]);
  material_law m = {edge,          edge,         OF_LINK(k_s),  OF_LINK(k_ns), OF_LINK(k_ts),
                    OF_LINK(d_s),  OF_LINK(d_ns), OF_LINK(d_ts), OF_LINK(k_z),  OF_LINK(k_xz),
                    OF_LINK(k_yz), OF_LINK(d_z),  OF_LINK(d_xz), OF_LINK(d_yz)};
#undef OF_LINK
  axis_law law = {NAME(paper_law_of)(body, 0), NAME(paper_law_of)(body, axis), m,
                  SPLAT(body->edge_ratio)};
  return law;
}

#if HAS_PRESSURE
#define PRESSURE_AT(task) (((task)->fields - PRESSURE_SIZE) * W)
/* The pressure of an element, or of a pack, of a row of `task`; and what the pressures of its
 * elements do to a link. */
#define PRESSURE_OF(p) NAME(pressure_at)((p) + PRESSURE_AT(task))
#define BETWEEN(i, j, axis) \
  pressure_on_link(i, j, axis, SPLAT(d.bodies[task->body].inverse_edge[axis]), IS_BENT)
#define READ_PART(c) a.c = LOAD(p), p += W;
#define WRITE_PART(c) STORE(a.c, p), p += W;
#define ADD_PART(c) a.c = a.c + b.c;
static inline pressure NAME(pressure_at)(global const NUMBER* p) {
  pressure a = pressure_zero();
  COMPONENTS_OF_PRESSURE(READ_PART)
  return a;
}
static inline void NAME(put_pressure)(pressure a, global NUMBER* p) {
  COMPONENTS_OF_PRESSURE(WRITE_PART)
}
static inline pressure NAME(pressure_sum)(pressure a, pressure b) {
  COMPONENTS_OF_PRESSURE(ADD_PART)
  return a;
}
#undef READ_PART
#undef WRITE_PART
#undef ADD_PART
static inline pressure NAME(strain)(global const body_constants* body, element i, element j,
                                    const int axis) {
  return link_strain(i, j, axis, SPLAT(body->edge[axis]), SPLAT(body->inverse_edge[axis]), IS_BENT);
}
/* Adds the loads' shares to the sum of strains of a pack, and stores the pressures.
 * @param place  offset of the pack's first field in its row */
static inline void NAME(finish_pressure)(device d, global const row_stage* task,
                                         global const NUMBER* signals, const int pack,
                                         const long place, pressure a) {
  global const pressure_lanes* c = d.pressures + d.pressure_index[task->masks + pack];
  if (task->face_strains >= 0) {
    global const applied_row* loads = d.face_strains + task->face_strains;
    for (int n = 0; n < loads->pattern_count; ++n) {
      global const pattern* q = d.patterns + loads->patterns + n;
      if (pack < q->first || pack >= q->first + q->packs) continue;
      a.s = FMA(SPLAT(signals[q->signal]),
                LOAD(d.arena + q->values + (long)(pack - q->first) * W + LANE), a.s);
    }
  }
#define TIMES_CONSTANT(part) a.part = LOAD(c->part.lane + LANE) * a.part;
  COMPONENTS_OF_PRESSURE(TIMES_CONSTANT)
#undef TIMES_CONSTANT
  NAME(put_pressure)(a, d.arena + task->out + place + PRESSURE_AT(task));
}
#else
#define PRESSURE_OF(p) pressure_zero()
#define BETWEEN(i, j, axis) no_pressure()
#endif

static inline wrench NAME(apply)(device d, global const row_stage* task,
                                 global const NUMBER* signals, const int pack, wrench sum) {
  global const applied_row* a = d.applied + task->applied;
  for (int n = 0; n < a->pattern_count; ++n) {
    global const pattern* q = d.patterns + a->patterns + n;
    if (pack < q->first || pack >= q->first + q->packs) continue;
    const REAL value = SPLAT(signals[q->signal] * d.bodies[task->body].inverse_unit);
    global const NUMBER* p =
        d.arena + q->values + (long)(pack - q->first) * (WRENCH_SIZE * W) + LANE;
#define ADD_PATTERN(c) c = FMA(value, LOAD(p), c), p += W;
    EACH_OF_VEC(ADD_PATTERN, sum.force)
    EACH_OF_SPIN(ADD_PATTERN, sum.moment)
  }
  return sum;
}
static inline void NAME(hold)(device d, global const row_stage* task, const int pack, vec* force,
                              spin* angular) {
  global const applied_row* a = d.applied + task->applied;
  if (a->free_lanes < 0) return;
  global const ushort* free_lanes = d.free_lanes + a->free_lanes + (pack - a->first) * WRENCH_SIZE;
#define HOLD(c)                      \
  {                                  \
    const uint mask = *free_lanes++; \
    KEEP(c)                          \
  }
  vec f = *force;
  spin t = *angular;
  EACH_OF_VEC(HOLD, f)
  EACH_OF_SPIN(HOLD, t)
  *force = f, *angular = t;
}

/* From the sum over the links to the updated state of a pack.
 * @param place  offset of the pack's first field in its row
 * @return `check` plus 0, or plus NaN if a result that must be finite is not */
static inline REAL NAME(update)(device d, global const row_stage* task,
                                global const NUMBER* signals, const int pack, const long place,
                                prepared i, wrench sum, REAL check) {
  global const body_constants* body = d.bodies + task->body;
  const bool is_applied = task->applied >= 0 && pack >= d.applied[task->applied].first &&
                          pack < d.applied[task->applied].first + d.applied[task->applied].packs;
  const tie_law tie = {SPLAT(body->tie_k), SPLAT(body->tie_d), SPLAT(body->tie_k2_rot),
                       SPLAT(body->tie_d_rot)};
  sum = wrench_finished(sum, i, NAME(paper_law_of)(body, 0), tie, FLAGS);
  if (is_applied) sum = NAME(apply)(d, task, signals, pack, sum);
#ifdef HAS_FRAME
  if (FLAGS.is_gyroscopic && FLAGS.is_tied && task->inverse_ratios >= 0) {
    global const NUMBER* p = d.arena + task->inverse_ratios + (long)pack * W + LANE;
    const REAL inverse = LOAD(p);
    sum.force = vec_scale(inverse, sum.force);
    sum.moment = spin_scale(inverse, sum.moment);
  }
#endif
  if (body->is_accelerated) sum.force = vec_axpy(SPLAT(body->mass), vec_splat(signals), sum.force);
  spin angular = turn(sum.moment, i.e, spin_splat(body->inertia), spin_splat(body->inverse_inertia),
                      FLAGS.is_gyroscopic);
#ifdef HAS_FRAME
  if (FLAGS.is_gyroscopic && FLAGS.is_tied && body->frame_signal > 0) {
    global const NUMBER* rate = signals + body->frame_signal;
    const frame_turn frame = {spin_splat(rate), spin_splat(rate + 3)};
    const vec rest = vec_at(d.arena + task->rest + (long)pack * (VEC_SIZE * W) + LANE);
    sum.force = frame_force(i.e, rest, frame, SPLAT(body->mass), sum.force);
    angular = turn_in_frame(sum.moment, i.e, frame, spin_splat(body->inertia),
                            spin_splat(body->inverse_inertia));
  }
#endif
  if (is_applied) NAME(hold)(d, task, pack, &sum.force, &angular);
  const device_row row = {d.arena, task};
  const row_update k =
      update_of_row(row, SPLAT(task->beta * d.step), SPLAT(body->inverse_mass),
                    SPLAT(FLAGS.is_gyroscopic ? 1 : body->inverse_inertia[2]));
  return updated(k, place, i.e, sum.force, angular, check);
}
