/* The rows of GPUs: a REAL is a number, and a work-item computes one element. No work-item waits
 * for another. So every link is computed at both ends: a result of one end for the other would go
 * through memory, which limits the speed. */

static inline vec NAME(upper_x)(prepared i) {
  return FLAGS.is_material ? i.e.u : upper_face(i.pull, i.x);
}
static inline exchange NAME(exchange_x)(prepared i, prepared j, axis_law law,
                                        link_pressure pressure) {
  return link_exchange(i.e, NAME(upper_x)(i), j.e, FLAGS.is_material ? i.e.u : j.lower_x, 0, law,
                       pressure, FLAGS);
}

/* Adds the links across y or z.
 * @param above, below  whether there is a link to the upper and to the lower element */
static inline wrench NAME(add_across)(wrench sum, prepared i, const int axis, axis_law law,
                                      axis_law law_below, const int above, const int below,
                                      global const NUMBER* upper, global const NUMBER* lower,
                                      device d, global const row_stage* task,
                                      const pressure own_pressure) {
  if (!(above || below)) return sum;
  const side own = side_across(i, axis, law, FLAGS);
  exchange up = no_exchange();
  if (above) {
    const link_pressure pressure = BETWEEN(own_pressure, PRESSURE_OF(upper), axis);
    up = link_across(i.e, own.upper, element_at(upper), axis, law, pressure, FLAGS);
  }
  carried low = nothing_carried();
  if (below) {
    const element j = element_at(lower);
    const link_pressure pressure = BETWEEN(PRESSURE_OF(lower), own_pressure, axis);
    low = carried_by(link_across(j, upper_across(j, axis, law_below, FLAGS), i.e, axis, law_below,
                                 pressure, FLAGS),
                     FLAGS);
  }
  return wrench_across(sum, up, low, own.arm, axis, law, FLAGS);
}

/* Places of the elements beside one along x.
 * @param place  of the element in its row */
static inline long NAME(place_above)(const long place, const int lane, const int stride) {
  return lane + 1 < W ? place + 1 : place - lane + stride;
}
static inline long NAME(place_below)(const long place, const int lane, const int stride) {
  return lane > 0 ? place - 1 : place - stride + W - 1;
}
static inline bool NAME(is_linked_below)(global const pack_masks* masks, const int pack,
                                         const int lane) {
  return lane > 0 ? masks->link_x >> (lane - 1) & 1
                  : pack > 0 && (masks[-1].link_x >> (W - 1) & 1);
}

#if HAS_PRESSURE
/* Adds the strains of the links across y or z, each of which is computed at both ends too. */
static inline pressure NAME(add_strains)(pressure sum, global const body_constants* body, element i,
                                         const int axis, const int above, const int below,
                                         global const NUMBER* upper, global const NUMBER* lower) {
  if (above) sum = NAME(pressure_sum)(sum, NAME(strain)(body, i, element_at(upper), axis));
  if (below) sum = NAME(pressure_sum)(sum, NAME(strain)(body, element_at(lower), i, axis));
  return sum;
}
static inline void NAME(find_pressure)(device d, global const row_stage* task,
                                       global const NUMBER* signals) {
  const int pack = PACK(task), lane = LANE, stride = task->fields * W;
  global const pack_masks* masks = d.masks + task->masks + pack;
  global const body_constants* body = d.bodies + task->body;
  const long place = (long)pack * stride + lane;
  global const NUMBER* in = d.arena + task->in;
  const element i = element_at(in + place);
  pressure up = pressure_zero(), low = pressure_zero();
  if (masks->link_x >> lane & 1)
    up = NAME(strain)(body, i, element_at(in + NAME(place_above)(place, lane, stride)), 0);
  if (NAME(is_linked_below)(masks, pack, lane))
    low = NAME(strain)(body, element_at(in + NAME(place_below)(place, lane, stride)), i, 0);
  pressure sum = NAME(pressure_sum)(up, low);
#if AXES > 1
  sum = NAME(add_strains)(sum, body, i, 1, masks->link_y >> lane & 1, masks->below_y >> lane & 1,
                          d.arena + task->upper_y + place, d.arena + task->lower_y + place);
#endif
#if AXES > 2
  sum = NAME(add_strains)(sum, body, i, 2, masks->link_z >> lane & 1, masks->below_z >> lane & 1,
                          d.arena + task->upper_z + place, d.arena + task->lower_z + place);
#endif
  NAME(finish_pressure)(d, task, signals, pack, place, sum);
}
#endif

/* @return whether the result of a last stage is finite */
static inline int NAME(run)(device d, global const row_stage* task, global const NUMBER* signals) {
  const int pack = PACK(task), lane = LANE;
  if (pack < 0 || pack >= task->packs) return 1;
  if (task->action == find_pressure) {
#if HAS_PRESSURE
    NAME(find_pressure)(d, task, signals);
#endif
    return 1; /* else a body without pressures, beside one that has them */
  }
  global const pack_masks* masks = d.masks + task->masks + pack;
  const axis_law x = NAME(law_of)(d, task, pack, 0, 0), x_below = NAME(law_of)(d, task, pack, 0, 1);
  const int stride = task->fields * W;
  const long place = (long)pack * stride + lane;
  global const NUMBER* in = d.arena + task->in;
  const prepared i = prepare(element_at(in + place), x.x, FLAGS);
  const pressure own_pressure = PRESSURE_OF(in + place);
  exchange up = no_exchange();
  if (masks->link_x >> lane & 1) {
    const long above = NAME(place_above)(place, lane, stride);
    up = NAME(exchange_x)(i, prepare(element_at(in + above), x.x, FLAGS), x,
                          BETWEEN(own_pressure, PRESSURE_OF(in + above), 0));
  }
  carried low = nothing_carried();
  if (NAME(is_linked_below)(masks, pack, lane)) {
    const long below = NAME(place_below)(place, lane, stride);
    const prepared j = prepare(element_at(in + below), x.x, FLAGS);
    const link_pressure pressure = BETWEEN(PRESSURE_OF(in + below), own_pressure, 0);
    low = carried_by(NAME(exchange_x)(j, i, x_below, pressure), FLAGS);
  }
  wrench sum = wrench_of_x(i, up, low, x, FLAGS);
#if AXES > 1
  sum = NAME(add_across)(sum, i, 1, NAME(law_of)(d, task, pack, 1, 0),
                         NAME(law_of)(d, task, pack, 1, 1), masks->link_y >> lane & 1,
                         masks->below_y >> lane & 1, d.arena + task->upper_y + place,
                         d.arena + task->lower_y + place, d, task, own_pressure);
#endif
#if AXES > 2
  sum = NAME(add_across)(sum, i, 2, NAME(law_of)(d, task, pack, 2, 0),
                         NAME(law_of)(d, task, pack, 2, 1), masks->link_z >> lane & 1,
                         masks->below_z >> lane & 1, d.arena + task->upper_z + place,
                         d.arena + task->lower_z + place, d, task, own_pressure);
#endif
  const REAL check = NAME(update)(d, task, signals, pack, place, i, sum, 0);
  return !(masks->own >> lane & 1) || IS_ZERO(check);
}
