/* One stage of one row for one combination of terms: FLAGS, NAME(f) = f_<number of the combination>. The loop is the includer's
 * (row_of_vectors.cl, row_of_items.cl); what is common to both is here. `d` is the device's tables. */

static inline exchange NAME(masked)(exchange x, const uint mask) {
  if (mask == ALL_LANES) return x;
  EACH_OF_VEC(KEEP, x.force)
  if (has_couples(FLAGS)) { EACH_OF_SPIN(KEEP, x.couple_i) }
  if (FLAGS.is_material) { EACH_OF_SPIN(KEEP, x.couple_j) }
  return x;
}
#define CARRY_SIZE(flags) (has_couples(flags) ? WRENCH_SIZE : VEC_SIZE)
static inline void NAME(put_carried)(carried c, global NUMBER* p) {
  put_vec(c.force, p);
  if (has_couples(FLAGS)) put_spin(c.couple, p + VEC_SIZE * W);
}
static inline carried NAME(carried_at)(global const NUMBER* p) {
  carried c = {vec_at(p), spin_zero()};
  if (has_couples(FLAGS)) c.couple = spin_at(p + VEC_SIZE * W);
  return c;
}

static inline paper_law NAME(paper_law_of)(global const body_constants* body, int axis) {
  if (!FLAGS.is_oblong) axis = 0;
  paper_law law = {SPLAT(body->edge[axis]), SPLAT(body->edge[axis] / 2), SPLAT(body->tau), SPLAT(body->kt2), SPLAT(body->dt)};
  return law;
}
static inline axis_law NAME(law_of)(global const body_constants* body, const int axis) {
  material_law m = {SPLAT(body->edge[axis]),      SPLAT(body->edge[axis]),      SPLAT(body->axis[axis].k_s),
                    SPLAT(body->axis[axis].k_ns), SPLAT(body->axis[axis].d_s),  SPLAT(body->axis[axis].d_ns),
                    SPLAT(body->axis[axis].k_z),  SPLAT(body->axis[axis].k_xz), SPLAT(body->axis[axis].k_yz),
                    SPLAT(body->axis[axis].d_z),  SPLAT(body->axis[axis].d_xz), SPLAT(body->axis[axis].d_yz)};
  axis_law law = {NAME(paper_law_of)(body, 0), NAME(paper_law_of)(body, axis), m, SPLAT(body->edge_ratio)};
  return law;
}

/* Links across y or z; `above`, `below`: masks; `upper` the upper pack, `carry` and `from` this pack's places. */
static inline wrench NAME(add_across)(wrench sum, prepared i, const int axis, axis_law law, const uint above, const uint below,
                                      global const NUMBER* upper, global NUMBER* carry, global const NUMBER* from) {
  if ((above | below) == 0) return sum;
  face own;
  vec upper_side = i.e.u;
  if (FLAGS.is_material) {
    own.arm = material_arm(i.e, axis, law.material);
  } else {
    own = face_across(i.e, i.x, axis, law, FLAGS);
    upper_side = upper_face(i.pull, own);
  }
  exchange up = no_exchange();
  if (above != 0) up = NAME(masked)(link_across(i.e, upper_side, element_at(upper), axis, law, FLAGS), above);
  carried low = nothing_carried();
  if (below != 0) low = NAME(carried_at)(from);
  sum = wrench_across(sum, up, low, own.arm, axis, law, FLAGS);
  if (above != 0) NAME(put_carried)(carried_by(up, FLAGS), carry); /* perhaps over what was read */
  return sum;
}

static inline wrench NAME(apply)(device d, global const row_stage* task, global const NUMBER* signals, const int pack,
                                 wrench sum) {
  global const applied_row* a = d.applied + task->applied;
  for (int n = 0; n < a->pattern_count; ++n) {
    global const pattern* q = d.patterns + a->patterns + n;
    if (pack < q->first || pack >= q->first + q->packs) continue;
    const REAL value = SPLAT(signals[q->signal] * d.bodies[task->body].inverse_unit);
    global const NUMBER* p = d.arena + q->values + (long)(pack - q->first) * (WRENCH_SIZE * W) + LANE;
#define ADD_PATTERN(c) c = FMA(value, LOAD(p), c), p += W;
    EACH_OF_VEC(ADD_PATTERN, sum.force) EACH_OF_SPIN(ADD_PATTERN, sum.moment)
  }
  return sum;
}
static inline void NAME(hold)(device d, global const row_stage* task, const int pack, vec* force, spin* angular) {
  global const applied_row* a = d.applied + task->applied;
  if (a->free_lanes < 0) return;
  global const ushort* free_lanes = d.free_lanes + a->free_lanes + (pack - a->first) * WRENCH_SIZE;
#define HOLD(c) { const uint mask = *free_lanes++; KEEP(c) }
  vec f = *force;
  spin t = *angular;
  EACH_OF_VEC(HOLD, f) EACH_OF_SPIN(HOLD, t)
  *force = f, *angular = t;
}

/* From the sum over the links to the update; `place`: of the pack's first field in its row. Adds to the check for finite
 * numbers. */
static inline REAL NAME(update)(device d, global const row_stage* task, global const NUMBER* signals, const int pack,
                                const long place, prepared i, wrench sum, REAL check) {
  global const body_constants* body = d.bodies + task->body;
  const bool is_applied =
      task->applied >= 0 && pack >= d.applied[task->applied].first &&
      pack < d.applied[task->applied].first + d.applied[task->applied].packs;
  const tie_law tie = {SPLAT(body->tie_k), SPLAT(body->tie_d), SPLAT(body->tie_k2_rot), SPLAT(body->tie_d_rot)};
  sum = wrench_finished(sum, i, NAME(paper_law_of)(body, 0), tie, FLAGS);
  if (is_applied) sum = NAME(apply)(d, task, signals, pack, sum);
  if (body->is_accelerated) sum.force = vec_axpy(SPLAT(body->mass), vec_splat(signals), sum.force);
  spin angular =
      turn(sum.moment, i.e, spin_splat(body->inertia), spin_splat(body->inverse_inertia), FLAGS.is_gyroscopic);
  if (is_applied) NAME(hold)(d, task, pack, &sum.force, &angular);
  return row_update(d, task, place, i.e, sum.force, SPLAT(body->inverse_mass), angular,
                    SPLAT(FLAGS.is_gyroscopic ? 1 : body->inverse_inertia[2]), check);
}

/* Only the links across an axis, for the rows above. */
static inline void NAME(prime)(device d, global const row_stage* task, const int axis) {
  const axis_law law = NAME(law_of)(d.bodies + task->body, axis);
  global const NUMBER* upper = d.arena + (axis == 1 ? task->upper_y : task->upper_z);
  global NUMBER* carry = d.arena + (axis == 1 ? task->carry_y : task->carry_z);
  for (int pack = FIRST_PACK(task); pack < task->packs; pack += PACKS_AT_ONCE) {
    const uint mask = axis == 1 ? d.masks[task->masks + pack].link_y : d.masks[task->masks + pack].link_z;
    if (mask == 0) continue;
    const long place = (long)pack * (task->fields * W) + LANE;
    const element i = element_at(d.arena + task->in + place), j = element_at(upper + place);
    const exchange up =
        NAME(masked)(link_across(i, upper_across(i, axis, law, FLAGS), j, axis, law, FLAGS), mask);
    NAME(put_carried)(carried_by(up, FLAGS), carry + (long)pack * (CARRY_SIZE(FLAGS) * W) + LANE);
  }
}
