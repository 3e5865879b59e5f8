/* Sum of the links of one element: its wrench, that is force and moment (shared subset). The
 * includer brings elements and link forces together (lanes of a pack, rows, work-items). The order
 * of summation is always x, y, z; the upper link before the lower; then ties. */

/* Which terms are compiled in. The flags are constants at every call; C++ has them as Terms
 * (kernels/terms.hpp). */
typedef struct {
  int is_material, is_damped, is_bending, is_gyroscopic, is_tied, is_oblong, has_two_shears,
      has_pressure;
} term_flags;
static inline int has_couples(const term_flags terms) {
  return terms.is_material || terms.is_damped || terms.is_bending;
}

#ifdef PLANAR
#define IS_PLANAR 1
#else
#define IS_PLANAR 0
#endif

/* Laws of the links across one axis. */
typedef struct {
  paper_law x, own; /* of the x axis; of this axis */
  material_law material;
  REAL edge_ratio; /* edge along y over edge along x */
} axis_law;

/* An element with what its links share (paper's law): u + tau v of its centre, its faces on the x
 * axis. */
typedef struct {
  element e;
  vec pull, lower_x;
  face x;
} prepared;

static inline prepared prepare(element e, paper_law law_x, const term_flags terms) {
  prepared r;
  r.e = e;
  if (!terms.is_material) {
    r.pull = centre_pull(e, law_x, terms.is_damped);
    r.x = element_face(e, 0, law_x, terms.is_damped);
    r.lower_x = lower_face(r.pull, r.x);
  }
  return r;
}

/* What a link hands to the element on its upper side: the force on i and a couple. The material law
 * adds the couple there, the paper's law subtracts it. */
typedef struct {
  vec force;
  spin couple;
} carried;
static inline carried carried_by(exchange x, const term_flags terms) {
  carried c = {x.force, terms.is_material ? x.couple_j : x.couple_i};
  return c;
}

/* Sums over an element's links. In the plane, forces on y faces are turned onto the x face, so that
 * one cross product gives the moment of all links. */
typedef struct {
  vec force;
  spin moment, couple;
  vec on_x_face;
} wrench;
static inline int has_one_lever(const term_flags terms) { return IS_PLANAR && !terms.is_material; }

static inline vec scaled_to_y(vec a, REAL edge_ratio, const term_flags terms) {
  return terms.is_oblong ? vec_scale(edge_ratio, a) : a;
}

/* Face of an element on axis 1 or 2. In the plane it is the x face, turned. */
static inline face face_across(element e, face x, const int axis, axis_law law,
                               const term_flags terms) {
  face f;
#if IS_PLANAR
  (void)e, (void)axis;
  f.arm = x.arm;
  f.swing = scaled_to_y(vec_turned(x.swing), law.edge_ratio, terms);
#else
  (void)x;
  f = element_face(e, axis, law.own, terms.is_damped);
#endif
  return f;
}
/* The same if the caller does not have the x face. */
static inline face face_across_alone(element e, const int axis, axis_law law,
                                     const term_flags terms) {
#if IS_PLANAR
  return face_across(e, element_face(e, 0, law.x, terms.is_damped), axis, law, terms);
#else
  return element_face(e, axis, law.own, terms.is_damped);
#endif
}
static inline lever material_arm(element e, const int axis, material_law law) {
  return face_arm(e.q, axis, law.edge_i, SPLAT(0.5) * law.edge_i);
}

/* Exchange over the link from i to j. `lower` is the lower face of j (paper's law), `upper` the
 * upper face of i, `pressure` what the pressures of both do (material law). */
static inline exchange link_exchange(element i, vec upper, element j, vec lower, const int axis,
                                     axis_law law, link_pressure pressure, const term_flags terms) {
  exchange x;
  if (terms.is_material)
    return material_link(i, j, axis, law.material, pressure, terms.is_damped, terms.has_two_shears,
                         terms.has_pressure);
  x.force = vec_sub(lower, upper);
  x.couple_i = has_couples(terms)
                   ? paper_couple(i.q, i.w, j.q, j.w, law.own, terms.is_bending, terms.is_damped)
                   : spin_zero();
  x.couple_j = spin_zero();
  return x;
}

/* An element's side to its upper neighbour across axis 1 or 2. */
typedef struct {
  lever arm;
  vec upper; /* operand of link_across that describes i */
} side;
static inline side side_across(prepared i, const int axis, axis_law law, const term_flags terms) {
  side s;
  if (terms.is_material) {
    s.arm = material_arm(i.e, axis, law.material);
    s.upper = i.e.u;
  } else {
    face own = face_across(i.e, i.x, axis, law, terms);
    s.arm = own.arm;
    s.upper = upper_face(i.pull, own);
  }
  return s;
}
/* Upper face of an element on axis 1 or 2, if the caller does not have its x face. */
static inline vec upper_across(element i, const int axis, axis_law law, const term_flags terms) {
  if (terms.is_material) return i.u;
  return upper_face(centre_pull(i, law.x, terms.is_damped), face_across_alone(i, axis, law, terms));
}
/* Exchange with the element j across a y or z face; `upper` is the upper face of i. */
static inline exchange link_across(element i, vec upper, element j, const int axis, axis_law law,
                                   link_pressure pressure, const term_flags terms) {
  vec lower = j.u;
  if (!terms.is_material)
    lower =
        lower_face(centre_pull(j, law.x, terms.is_damped), face_across_alone(j, axis, law, terms));
  return link_exchange(i, upper, j, lower, axis, law, pressure, terms);
}

/* The x links start the sums: `up` is the upper link's exchange, `low` what the lower link carried
 * here. */
static inline wrench wrench_of_x(prepared i, exchange up, carried low, axis_law law,
                                 const term_flags terms) {
  wrench sum;
  sum.force = vec_sub(up.force, low.force);
  sum.on_x_face = vec_add(up.force, low.force);
  sum.moment = spin_zero();
  if (!has_one_lever(terms))
    sum.moment = lever_cross(terms.is_material ? material_arm(i.e, 0, law.material) : i.x.arm, 0,
                             sum.on_x_face);
  sum.couple = spin_zero();
  if (terms.is_material)
    sum.couple = spin_add(up.couple_i, low.couple);
  else if (has_couples(terms))
    sum.couple = spin_sub(up.couple_i, low.couple);
  return sum;
}
/* Adds the links of axis 1 or 2; `arm` is the element's upper arm on that axis. */
static inline wrench wrench_across(wrench sum, exchange up, carried low, lever arm, const int axis,
                                   axis_law law, const term_flags terms) {
  vec both = vec_add(up.force, low.force);
  sum.force = vec_sub(vec_add(sum.force, up.force), low.force);
#if IS_PLANAR
  if (has_one_lever(terms))
    sum.on_x_face =
        vec_add(sum.on_x_face, scaled_to_y(vec_turned_back(both), law.edge_ratio, terms));
  else
    sum.moment = lever_moment(arm, axis, both, sum.moment);
#else
  (void)law;
  sum.moment = lever_moment(arm, axis, both, sum.moment);
#endif
  if (terms.is_material)
    sum.couple = spin_add(spin_add(sum.couple, up.couple_i), low.couple);
  else if (has_couples(terms))
    sum.couple = spin_sub(spin_add(sum.couple, up.couple_i), low.couple);
  return sum;
}
/* Adds the couples to the moment, and the ties to force and moment. */
static inline wrench wrench_finished(wrench sum, prepared i, paper_law law_x, tie_law tie,
                                     const term_flags terms) {
  if (has_one_lever(terms)) sum.moment = lever_cross(i.x.arm, 0, sum.on_x_face);
  if (terms.is_material)
    sum.moment = spin_add(sum.moment, sum.couple);
  else if (has_couples(terms))
    sum.moment = couple_moment(sum.couple, law_x, terms.is_bending, sum.moment);
  if (terms.is_tied) {
    sum.force = tie_force(i.e, tie, sum.force);
    sum.moment = tie_moment(i.e, tie, sum.moment);
  }
  return sum;
}

/* A link outside the grid: force and moment on i; on j the negative force and moment_j. */
typedef struct {
  vec force;
  spin moment_i, moment_j;
} pair_wrench;
static inline pair_wrench wrench_of_pair(element i, element j, const int axis,
                                         const int is_material, material_law material,
                                         paper_law law_i, paper_law law_j) {
  pair_wrench w;
  exchange x = is_material ? material_link(i, j, axis, material, no_pressure(), 1, 1, 0)
                           : paper_link(i, j, axis, law_i, law_j, 1, 1);
  w.force = x.force;
  w.moment_i =
      lever_moment(face_arm(i.q, axis, law_i.edge, law_i.half_edge), axis, x.force, x.couple_i);
  w.moment_j =
      lever_moment(face_arm(j.q, axis, law_j.edge, law_j.half_edge), axis, x.force, x.couple_j);
  return w;
}
#undef IS_PLANAR
