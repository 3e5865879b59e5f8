/* Computes the extra links (links outside the grid) one by one, in their order, into the wrenches
 * that rows add (variants/engine/staged.hpp). A REAL is a number. There is one work-item, because
 * such links are few. */
#define CLEAR_AT(p) \
  for (int c = 0; c < WRENCH_SIZE; ++c) (p)[c * W] = 0;
#define ADD_FORCE(c) *p = FMA(scale, c, *p), p += W;
static inline void add_wrench(global NUMBER* p, const NUMBER sign, const NUMBER unit, vec force,
                              spin moment) {
  NUMBER scale = sign * unit;
  EACH_OF_VEC(ADD_FORCE, force)
  scale = unit;
  EACH_OF_SPIN(ADD_FORCE, moment)
}
static inline pair_wrench wrench_of_extra(global const extra_link* link, element i, element j,
                                          const int axis) {
  global const body_constants* b = &link->body;
  const material_law m = {
      link->edge_i,       link->edge_j,       b->axis[axis].k_s,  b->axis[axis].k_ns,
      b->axis[axis].k_ts, b->axis[axis].d_s,  b->axis[axis].d_ns, b->axis[axis].d_ts,
      b->axis[axis].k_z,  b->axis[axis].k_xz, b->axis[axis].k_yz, b->axis[axis].d_z,
      b->axis[axis].d_xz, b->axis[axis].d_yz};
  const paper_law law_i = {link->edge_i, link->edge_i / 2, b->tau, b->kt2, b->dt},
                  law_j = {link->edge_j, link->edge_j / 2, b->tau, b->kt2, b->dt};
  return wrench_of_pair(i, j, axis, link->is_material, m, law_i, law_j);
}
/* @param row_starts  offset of the input of each row */
kernel void evaluate_extra_links(global NUMBER* arena, global const extra_link* links,
                                 const int count, global const long* row_starts) {
  for (int n = 0; n < count; ++n) {
    CLEAR_AT(arena + links[n].wrench_i)
    CLEAR_AT(arena + links[n].wrench_j)
  }
  for (int n = 0; n < count; ++n) {
    global const extra_link* link = links + n;
    const element i = element_at(arena + row_starts[link->row_i] + link->lane_i),
                  j = element_at(arena + row_starts[link->row_j] + link->lane_j);
    pair_wrench w;
    if (link->axis == 0) w = wrench_of_extra(link, i, j, 0);
#if AXES > 1
    else if (link->axis == 1)
      w = wrench_of_extra(link, i, j, 1);
#endif
#if AXES > 2
    else
      w = wrench_of_extra(link, i, j, 2);
#endif
    add_wrench(arena + link->wrench_i, 1, link->unit, w.force, w.moment_i);
    add_wrench(arena + link->wrench_j, -1, link->unit, w.force, w.moment_j);
  }
}
