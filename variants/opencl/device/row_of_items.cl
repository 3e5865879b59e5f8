/* The rows of GPUs: a REAL is a number, a work-item one lane of every PACKS_AT_ONCE-th pack of the body's grid, the same lane in
 * all rows, so that what it carries to the row above it reads there itself. Links along x are computed at both ends. */

static inline exchange NAME(exchange_x)(prepared i, prepared j, axis_law law) {
  return link_exchange(i.e, FLAGS.is_material ? i.e.u : upper_face(i.pull, i.x), j.e,
                       FLAGS.is_material ? i.e.u : j.lower_x, 0, law, FLAGS);
}

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
  const int lane = LANE;
  global const NUMBER* in = d.arena + task->in;
  REAL check = 0;
  for (int pack = FIRST_PACK(task); pack < task->packs; pack += PACKS_AT_ONCE) {
    const long start = (long)pack * stride, place = start + lane, carry = (long)pack * carry_size + lane;
    const prepared i = prepare(element_at(in + place), x.x, FLAGS);
    exchange up = no_exchange();
    if (masks[pack].link_x >> lane & 1) {
      const long above = lane + 1 < W ? place + 1 : start + stride;
      up = NAME(exchange_x)(i, prepare(element_at(in + above), x.x, FLAGS), x);
    }
    carried low = nothing_carried();
    const bool is_linked_below = lane > 0 ? masks[pack].link_x >> (lane - 1) & 1
                                          : pack > 0 && (masks[pack - 1].link_x >> (W - 1) & 1);
    if (is_linked_below) {
      const long below = lane > 0 ? place - 1 : start - stride + W - 1;
      low = carried_by(NAME(exchange_x)(prepare(element_at(in + below), x.x, FLAGS), i, x), FLAGS);
    }
    wrench sum = wrench_of_x(i, up, low, x, FLAGS);
#if AXES > 1
    sum = NAME(add_across)(sum, i, 1, y, masks[pack].link_y, masks[pack].below_y, d.arena + task->upper_y + place,
                           d.arena + task->carry_y + carry, d.arena + task->from_y + carry);
#endif
#if AXES > 2
    sum = NAME(add_across)(sum, i, 2, z, masks[pack].link_z, masks[pack].below_z, d.arena + task->upper_z + place,
                           d.arena + task->carry_z + carry, d.arena + task->from_z + carry);
#endif
    const REAL checked = NAME(update)(d, task, signals, pack, place, i, sum, check);
    if (masks[pack].own >> lane & 1) check = checked;
  }
  return IS_ZERO(check);
}
