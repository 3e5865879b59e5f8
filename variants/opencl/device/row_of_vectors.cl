/* The rows of CPU devices: a REAL is a pack, a work-item goes along the row (as kernels/stage_row/stage_row.hpp does). */

static inline wrench NAME(links_x)(prepared i, prepared next, axis_law law, const uint mask, carried* previous) {
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
  const exchange up = NAME(masked)(link_exchange(i.e, upper, j, lower, 0, law, FLAGS), mask);
  const carried own = carried_by(up, FLAGS);
  carried low = nothing_carried();
  low.force = vec_from_below(previous->force, own.force);
  if (has_couples(FLAGS)) low.couple = spin_from_below(previous->couple, own.couple);
  *previous = own;
  return wrench_of_x(i, up, low, law, FLAGS);
}

/* True if what a last stage left is finite. */
static inline int NAME(run_row)(device d, global const row_stage* task, global const NUMBER* signals) {
  global const body_constants* body = d.bodies + task->body;
  global const pack_masks* masks = d.masks + task->masks;
  const axis_law x = NAME(law_of)(body, 0);
#if AXES > 1
  const axis_law y = NAME(law_of)(body, 1);
#endif
#if AXES > 2
  const axis_law z = NAME(law_of)(body, 2);
#endif
  const int stride = task->fields * W, carry_size = CARRY_SIZE(FLAGS) * W;
  global const NUMBER* in = d.arena + task->in;
  REAL check = SPLAT(0);
  carried previous = nothing_carried();
  prepared next = prepare(element_at(in), x.x, FLAGS);
  for (int pack = 0; pack < task->packs; ++pack) {
    const long place = (long)pack * stride, carry = (long)pack * carry_size;
    prepared i = next;
    i.e = element_at(in + place);
    next = prepare(element_at(in + place + stride), x.x, FLAGS);
    wrench sum = NAME(links_x)(i, next, x, masks[pack].link_x, &previous);
#if AXES > 1
    sum = NAME(add_across)(sum, i, 1, y, masks[pack].link_y, masks[pack].below_y, d.arena + task->upper_y + place,
                           d.arena + task->carry_y + carry, d.arena + task->from_y + carry);
#endif
#if AXES > 2
    sum = NAME(add_across)(sum, i, 2, z, masks[pack].link_z, masks[pack].below_z, d.arena + task->upper_z + place,
                           d.arena + task->carry_z + carry, d.arena + task->from_z + carry);
#endif
    check = NAME(update)(d, task, signals, pack, place, i, sum, check);
  }
  return IS_ZERO(check);
}
