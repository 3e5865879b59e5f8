/* The rows of GPUs: a REAL is a number, and a work-item computes one element. No work-item waits
 * for another. So every link is computed at both ends: a result of one end for the other would go
 * through memory, which limits the speed. */

static inline vec NAME(upper_x)(prepared i) {
  return FLAGS.is_material ? i.e.u : upper_face(i.pull, i.x);
}
static inline exchange NAME(exchange_x)(prepared i, prepared j, axis_law law) {
  return link_exchange(i.e, NAME(upper_x)(i), j.e, FLAGS.is_material ? i.e.u : j.lower_x, 0, law,
                       FLAGS);
}

/* Adds the links across y or z.
 * @param above, below  whether there is a link to the upper and to the lower element */
static inline wrench NAME(add_across)(wrench sum, prepared i, const int axis, axis_law law,
                                      axis_law law_below, const int above, const int below,
                                      global const NUMBER* upper, global const NUMBER* lower) {
  if (!(above || below)) return sum;
  const side own = side_across(i, axis, law, FLAGS);
  exchange up = no_exchange();
  if (above) up = link_across(i.e, own.upper, element_at(upper), axis, law, FLAGS);
  carried low = nothing_carried();
  if (below) {
    const element j = element_at(lower);
    low = carried_by(link_across(j, upper_across(j, axis, law_below, FLAGS), i.e, axis, law_below,
                                 FLAGS),
                     FLAGS);
  }
  return wrench_across(sum, up, low, own.arm, axis, law, FLAGS);
}

/* @return whether the result of a last stage is finite */
static inline int NAME(run)(device d, global const row_stage* task, global const NUMBER* signals) {
  const int pack = PACK(task), lane = LANE;
  if (pack < 0 || pack >= task->packs) return 1;
  global const pack_masks* masks = d.masks + task->masks + pack;
  const axis_law x = NAME(law_of)(d, task, pack, 0, 0), x_below = NAME(law_of)(d, task, pack, 0, 1);
  const int stride = task->fields * W;
  const long start = (long)pack * stride, place = start + lane;
  global const NUMBER* in = d.arena + task->in;
  const prepared i = prepare(element_at(in + place), x.x, FLAGS);
  exchange up = no_exchange();
  if (masks->link_x >> lane & 1) {
    const long above = lane + 1 < W ? place + 1 : start + stride;
    up = NAME(exchange_x)(i, prepare(element_at(in + above), x.x, FLAGS), x);
  }
  carried low = nothing_carried();
  const bool is_linked_below =
      lane > 0 ? masks->link_x >> (lane - 1) & 1 : pack > 0 && (masks[-1].link_x >> (W - 1) & 1);
  if (is_linked_below) {
    const long below = lane > 0 ? place - 1 : start - stride + W - 1;
    const prepared j = prepare(element_at(in + below), x.x, FLAGS);
    low = carried_by(NAME(exchange_x)(j, i, x_below), FLAGS);
  }
  wrench sum = wrench_of_x(i, up, low, x, FLAGS);
#if AXES > 1
  sum = NAME(add_across)(sum, i, 1, NAME(law_of)(d, task, pack, 1, 0),
                         NAME(law_of)(d, task, pack, 1, 1), masks->link_y >> lane & 1,
                         masks->below_y >> lane & 1, d.arena + task->upper_y + place,
                         d.arena + task->lower_y + place);
#endif
#if AXES > 2
  sum = NAME(add_across)(sum, i, 2, NAME(law_of)(d, task, pack, 2, 0),
                         NAME(law_of)(d, task, pack, 2, 1), masks->link_z >> lane & 1,
                         masks->below_z >> lane & 1, d.arena + task->upper_z + place,
                         d.arena + task->lower_z + place);
#endif
  const REAL check = NAME(update)(d, task, signals, pack, place, i, sum, 0);
  return !(masks->own >> lane & 1) || IS_ZERO(check);
}
