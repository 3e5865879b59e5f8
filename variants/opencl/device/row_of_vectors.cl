/* The rows of CPU devices: a REAL is a pack, and a work-item goes along the row as
 * kernels/stage_row/stage_row.hpp does. */

#define CARRY_SIZE(flags) (has_couples(flags) ? WRENCH_SIZE : VEC_SIZE)

static inline exchange NAME(masked)(exchange x, const uint mask) {
  if (mask == ALL_LANES) return x;
  EACH_OF_VEC(KEEP, x.force)
  if (has_couples(FLAGS)) {
    EACH_OF_SPIN(KEEP, x.couple_i)
  }
  if (FLAGS.is_material) {
    EACH_OF_SPIN(KEEP, x.couple_j)
  }
  return x;
}
static inline void NAME(put_carried)(carried c, global NUMBER* p) {
  put_vec(c.force, p);
  if (has_couples(FLAGS)) put_spin(c.couple, p + VEC_SIZE * W);
}
static inline carried NAME(carried_at)(global const NUMBER* p) {
  carried c = {vec_at(p), spin_zero()};
  if (has_couples(FLAGS)) c.couple = spin_at(p + VEC_SIZE * W);
  return c;
}

/* Spatial rows of the paper's law have more live numbers than there are registers. They store what
 * the next pack takes of its preparation, and load it where it is used, as parked rows of
 * stage_row.hpp do. */
#if AXES == 3 && FIELDS == 13
#define IS_PARKED (!FLAGS.is_material && !FLAGS.is_bending)
#define PARKED_SIZE (4 * VEC_SIZE)
#define PARK(c) *p++ = (c);
#define UNPARK(c) c = *p++;
#define EACH_PARKED(act, a)      \
  EACH_OF_VEC(act, (a).pull)     \
  EACH_OF_VEC(act, (a).lower_x)  \
  EACH_OF_VEC(act, (a).x.arm)    \
  EACH_OF_VEC(act, (a).x.swing)

static inline void NAME(park)(const prepared a, volatile REAL* p) {
  EACH_PARKED(PARK, a)
}
static inline prepared NAME(parked)(volatile const REAL* p, global const NUMBER* fields) {
  prepared a;
  EACH_PARKED(UNPARK, a)
  FORGET_LOADS
  a.e = element_at(fields);
  return a;
}
#define PARK_NEXT(place) \
  if (IS_PARKED) NAME(park)(next, places[(place)&1]);
#define READ_AGAIN \
  if (IS_PARKED) i = NAME(parked)(places[pack & 1], in + place);
#else
#define PARKED_SIZE 1
#define PARK_NEXT(place)
#define READ_AGAIN
#endif

#if HAS_PRESSURE
static inline pressure NAME(pressure_from_above)(pressure a, pressure b) {
  pressure r = pressure_zero();
  COMPONENTS_OF_PRESSURE(FROM_ABOVE)
  return r;
}
static inline pressure NAME(pressure_from_below)(pressure a, pressure b) {
  pressure r = pressure_zero();
  COMPONENTS_OF_PRESSURE(FROM_BELOW)
  return r;
}
#endif

static inline wrench NAME(links_x)(prepared i, prepared next, axis_law law,
                                   link_pressure pressure, const uint mask, carried* previous) {
  element j = i.e;
  vec lower = i.e.u, upper = i.e.u;
  if (FLAGS.is_material) {
    j.u = vec_from_above(i.e.u, next.e.u);
    j.v = vec_from_above(i.e.v, next.e.v);
  } else {
    lower = vec_from_above(i.lower_x, next.lower_x);
    upper = upper_face(i.pull, i.x);
  }
  if (FLAGS.is_material | FLAGS.is_bending) j.q = rotor_from_above(i.e.q, next.e.q);
  if (FLAGS.is_material | FLAGS.is_damped) j.w = spin_from_above(i.e.w, next.e.w);
  const exchange up =
      NAME(masked)(link_exchange(i.e, upper, j, lower, 0, law, pressure, FLAGS), mask);
  const carried own = carried_by(up, FLAGS);
  carried low = nothing_carried();
  low.force = vec_from_below(previous->force, own.force);
  if (has_couples(FLAGS)) low.couple = spin_from_below(previous->couple, own.couple);
  *previous = own;
  return wrench_of_x(i, up, low, law, FLAGS);
}

/* Adds the links across y or z.
 * @param above, below  lane masks of the links to the upper and to the lower row
 * @param upper         the upper pack
 * @param carry, from   places of this pack in the carry buffers */
static inline wrench NAME(add_across)(wrench sum, prepared i, const int axis, axis_law law,
                                      const uint above, const uint below,
                                      global const NUMBER* upper, global NUMBER* carry,
                                      global const NUMBER* from, device d,
                                      global const row_stage* task, const pressure own_pressure) {
  if ((above | below) == 0) return sum;
  const side own = side_across(i, axis, law, FLAGS);
  exchange up = no_exchange();
  if (above != 0) {
    const link_pressure pressure = BETWEEN(own_pressure, PRESSURE_OF(upper), axis);
    up = NAME(masked)(
        link_across(i.e, own.upper, element_at(upper), axis, law, pressure, FLAGS), above);
  }
  carried low = nothing_carried();
  if (below != 0) low = NAME(carried_at)(from);
  sum = wrench_across(sum, up, low, own.arm, axis, law, FLAGS);
  /* Written last, since carry and from may be the same place. */
  if (above != 0) NAME(put_carried)(carried_by(up, FLAGS), carry);
  return sum;
}

/* @return whether the result of a last stage is finite */
static inline int NAME(run_row)(device d, global const row_stage* task,
                                global const NUMBER* signals) {
  global const pack_masks* masks = d.masks + task->masks;
  axis_law x, y, z;
#define SET_LAWS(pack)                            \
  x = NAME(law_of)(d, task, pack, 0, 0);          \
  if (AXES > 1) y = NAME(law_of)(d, task, pack, 1, 0); \
  if (AXES > 2) z = NAME(law_of)(d, task, pack, 2, 0);
  SET_LAWS(0)
  const int stride = task->fields * W, carry_size = CARRY_SIZE(FLAGS) * W;
  global const NUMBER* in = d.arena + task->in;
  REAL check = SPLAT(0);
  carried previous = nothing_carried();
  prepared next = prepare(element_at(in), x.x, FLAGS);
  volatile REAL places[2][PARKED_SIZE]; /* of this pack and of the next, by turns */
  pressure next_pressure = PRESSURE_OF(in);
  PARK_NEXT(0)
  for (int pack = 0; pack < task->packs; ++pack) {
    const long place = (long)pack * stride, carry = (long)pack * carry_size;
    prepared i = next;
    i.e = element_at(in + place);
    next = prepare(element_at(in + place + stride), x.x, FLAGS);
    const pressure own_pressure = next_pressure;
    next_pressure = PRESSURE_OF(in + place + stride);
#if HAS_LINK_KINDS
    SET_LAWS(pack)
#endif
    const link_pressure to_next =
        BETWEEN(own_pressure, NAME(pressure_from_above)(own_pressure, next_pressure), 0);
    PARK_NEXT(pack + 1)
    READ_AGAIN
    wrench sum = NAME(links_x)(i, next, x, to_next, masks[pack].link_x, &previous);
    READ_AGAIN
#if AXES > 1
    sum = NAME(add_across)(sum, i, 1, y, masks[pack].link_y, masks[pack].below_y,
                           d.arena + task->upper_y + place, d.arena + task->carry_y + carry,
                           d.arena + task->from_y + carry, d, task, own_pressure);
#endif
#if AXES > 2
    READ_AGAIN
    sum = NAME(add_across)(sum, i, 2, z, masks[pack].link_z, masks[pack].below_z,
                           d.arena + task->upper_z + place, d.arena + task->carry_z + carry,
                           d.arena + task->from_z + carry, d, task, own_pressure);
#endif
    READ_AGAIN
    check = NAME(update)(d, task, signals, pack, place, i, sum, check);
  }
#undef SET_LAWS
  return IS_ZERO(check);
}

#if HAS_PRESSURE
static inline pressure NAME(masked_strain)(pressure a, const uint mask) {
#define KEEP_PART(c) KEEP(a.c)
  if (mask != ALL_LANES) {
    COMPONENTS_OF_PRESSURE(KEEP_PART)
  }
#undef KEEP_PART
  return a;
}
/* Adds the links across y or z, as add_across. */
static inline pressure NAME(add_strains)(pressure sum, global const body_constants* body, element i,
                                         const int axis, const uint above, const uint below,
                                         global const NUMBER* upper, global NUMBER* carry,
                                         global const NUMBER* from) {
  pressure up = pressure_zero();
  if (above != 0) {
    up = NAME(masked_strain)(NAME(strain)(body, i, element_at(upper), axis), above);
    sum = NAME(pressure_sum)(sum, up);
  }
  if (below != 0) sum = NAME(pressure_sum)(sum, NAME(pressure_at)(from));
  if (above != 0) NAME(put_pressure)(up, carry);
  return sum;
}
/* The pressures of a row's elements, as PressureRow (kernels/stage_row/pressure_row.hpp). */
static inline void NAME(find_pressure)(device d, global const row_stage* task,
                                       global const NUMBER* signals) {
  global const pack_masks* masks = d.masks + task->masks;
  global const body_constants* body = d.bodies + task->body;
  const int stride = task->fields * W, carry_size = CARRY_SIZE(FLAGS) * W;
  global const NUMBER* in = d.arena + task->in;
  pressure previous = pressure_zero();
  element next = element_at(in);
  for (int pack = 0; pack < task->packs; ++pack) {
    const long place = (long)pack * stride, carry = (long)pack * carry_size;
    const element i = next;
    next = element_at(in + place + stride);
    element j = i;
    j.u = vec_from_above(i.u, next.u);
    j.q = rotor_from_above(i.q, next.q);
    const pressure up = NAME(masked_strain)(NAME(strain)(body, i, j, 0), masks[pack].link_x);
    pressure sum = NAME(pressure_sum)(up, NAME(pressure_from_below)(previous, up));
    previous = up;
#if AXES > 1
    sum = NAME(add_strains)(sum, body, i, 1, masks[pack].link_y, masks[pack].below_y,
                            d.arena + task->upper_y + place, d.arena + task->carry_y + carry,
                            d.arena + task->from_y + carry);
#endif
#if AXES > 2
    sum = NAME(add_strains)(sum, body, i, 2, masks[pack].link_z, masks[pack].below_z,
                            d.arena + task->upper_z + place, d.arena + task->carry_z + carry,
                            d.arena + task->from_z + carry);
#endif
    NAME(finish_pressure)(d, task, signals, pack, place, sum);
  }
}
#endif

/* Computes only the links across an axis, for the rows above, or only their strains. */
static inline void NAME(prime)(device d, global const row_stage* task, const int axis,
                               const int is_strain) {
  global const NUMBER* upper = d.arena + (axis == 1 ? task->upper_y : task->upper_z);
  global NUMBER* carry = d.arena + (axis == 1 ? task->carry_y : task->carry_z);
  for EACH_PACK(task) {
    const uint mask =
        axis == 1 ? d.masks[task->masks + pack].link_y : d.masks[task->masks + pack].link_z;
    if (mask == 0) continue;
    const long place = (long)pack * (task->fields * W) + LANE;
    const element i = element_at(d.arena + task->in + place), j = element_at(upper + place);
    global NUMBER* to = carry + (long)pack * (CARRY_SIZE(FLAGS) * W) + LANE;
#if HAS_PRESSURE
    if (is_strain) {
      const pressure up = NAME(strain)(d.bodies + task->body, i, j, axis);
      NAME(put_pressure)(NAME(masked_strain)(up, mask), to);
      continue;
    }
#endif
    const axis_law law = NAME(law_of)(d, task, pack, axis, 0);
    const link_pressure pressure =
        BETWEEN(PRESSURE_OF(d.arena + task->in + place), PRESSURE_OF(upper + place), axis);
    const exchange up = link_across(i, upper_across(i, axis, law, FLAGS), j, axis, law, pressure,
                                    FLAGS);
    NAME(put_carried)(carried_by(NAME(masked)(up, mask), FLAGS), to);
  }
}

/* Does the action of a row, for one combination of terms.
 * @return false if the last stage of a step left a number that is not finite */
static int NAME(run)(device d, global const row_stage* task, global const NUMBER* signals) {
  const int action = task->action;
  const int is_strain = action == prime_strain_y || action == prime_strain_z ||
                        action == prime_strain_upper;
#if HAS_PRESSURE
  if (action == find_pressure) {
    NAME(find_pressure)(d, task, signals);
    return 1;
  }
#else
  if (action == find_pressure || is_strain)
    return 1; /* a body without pressures, beside one that has them */
#endif
  switch (action) {
  case prime_upper:
  case prime_strain_upper:
    if (task->upper_y >= 0) NAME(prime)(d, task, 1, is_strain);
#if AXES > 2
    if (task->upper_z >= 0) NAME(prime)(d, task, 2, is_strain);
#endif
    return 1;
  case prime_y:
  case prime_strain_y:
    NAME(prime)(d, task, 1, is_strain);
    return 1;
#if AXES > 2
  case prime_z:
  case prime_strain_z:
    NAME(prime)(d, task, 2, is_strain);
    return 1;
#endif
  default:
    return NAME(run_row)(d, task, signals);
  }
}
