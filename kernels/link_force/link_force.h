/* Link laws of DESIGN.md section 2 (shared subset), in the operations of an algebra
 * (kernels/algebra). All quantities are in the global frame and in SI units. `axis` and the flags
 * are constants at every call, so the compiler removes their branches. */

typedef struct {
  vec u, v;
  rotor q;
  spin w;
} element; /* in the order in which the fields are stored */

/* What a link between element i and its neighbour j across the upper face of i exchanges. Force [N]
 * and couples [N m]; in the paper's law all are divided by k.
 *   on i:  force,  arm_i x force + couple_i
 *   on j: -force,  arm_j x force + couple_j */
typedef struct {
  vec force;
  spin couple_i, couple_j;
} exchange;

/* Paper's law
 * -----------
 * The law is isotropic. Let x [m] be the displacement of a face point and x' [m/s] its rate. The
 * force k D + d V is then the difference of k (x + tau x') between the two face points of the link,
 * with tau = d / k:
 *   upper face of i:  x = u + (A - I) c,   x' = v + w x a,   a = A c
 *   lower face of j:  x = u - (A - I) c,   x' = v - w x a
 *   F / k = (x + tau x') of j's lower face - (x + tau x') of i's upper face
 * The two faces of an element on one axis differ only in the sign of c, so one cross product gives
 * both moments. Forces and couples are in units of k (a force is a length). The constants of a body
 * divide mass and inertia by k, so the loop never multiplies by k. */

typedef struct {
  REAL edge, half_edge, tau, kt2, dt;
} paper_law; /* [m], [m]; d / k [s]; 2 kt / k [m^2]; dt / k [m^2 s] */
/* arm: a = A c [m]. swing: (A - I) c + tau w x a [m], which is x + tau x' of the upper face minus
 * u + tau v of the centre. */
typedef struct {
  lever arm;
  vec swing;
} face;

/* u + tau v [m] of the centre, common to all faces of an element */
static inline vec centre_pull(element e, paper_law law, const int is_damped) {
  return is_damped ? vec_axpy(law.tau, e.v, e.u) : e.u;
}
/* Arm a = A c from the centre to the upper face [m]. */
static inline lever face_arm(rotor q, const int axis, REAL edge, REAL half_edge) {
  return lever_of(rotor_turn(q, axis, edge), axis, half_edge);
}
/* Upper face of an element on an axis; the lower face has the opposite arm and swing. */
static inline face element_face(element e, const int axis, paper_law law, const int is_damped) {
  face f;
  f.swing = rotor_turn(e.q, axis, law.edge);
  f.arm = lever_of(f.swing, axis, law.half_edge);
  if (is_damped) f.swing = lever_rate(spin_scale(law.tau, e.w), f.arm, axis, f.swing);
  return f;
}
/* x + tau x' [m] of the lower and of the upper face; `pull` is centre_pull. */
static inline vec lower_face(vec pull, face f) { return vec_sub(pull, f.swing); }
static inline vec upper_face(vec pull, face f) { return vec_add(pull, f.swing); }
/* Couple T / k = 2 kt / k r + dt / k (w_j - w_i) on i, its negative on j. Without bending (kt = 0)
 * the result is only w_j - w_i. couple_moment then multiplies the element's sum by dt / k once. */
static inline spin paper_couple(rotor qi, spin wi, rotor qj, spin wj, paper_law law,
                                const int is_bending, const int is_damped) {
  spin turn_rate = spin_sub(wj, wi);
  if (!is_bending) return turn_rate;
  return is_damped ? spin_axpy(law.dt, turn_rate, spin_scale(law.kt2, rotor_relative(qi, qj)))
                   : spin_scale(law.kt2, rotor_relative(qi, qj));
}
static inline spin couple_moment(spin couples, paper_law law, const int is_bending, spin moment) {
  return is_bending ? spin_add(moment, couples) : spin_axpy(law.dt, couples, moment);
}

/* Material law
 * ------------
 * n_m = (A_i e_m + A_j e_m) / 2 is the mean direction of the body axis m (n: the link's own
 * axis), p = q_j conj(q_i) = (p0, r) the relative rotation, and b = a + D / 2 the arm to the
 * common point. The elastic energy is
 *   U = k_s |D|^2 / 2 + (k_n - k_s) (n.D)^2 / 2 + (k_t - k_s) (n_t.D)^2 / 2
 *       + 4 k_z (1 - p0) + 2 (k_x - k_z) (n_x.r)^2 + 2 (k_y - k_z) (n_y.r)^2
 * Its virtual work gives
 *   F = k_s D + (k_n - k_s) (n.D) n + (k_t - k_s) (n_t.D) n_t
 *   X = (k_n - k_s) (n.D) D x (n_i - n_j) / 4 + (k_t - k_s) (n_t.D) D x (n_ti - n_tj) / 4
 *   T = 2 k_z r + sum over m = x, y of 2 (k_m - k_z) (n_m.r) [p0 n_m + r x (n_mi - n_mj) / 2]
 *   moment on i: b_i x F + X + T,   on j: b_j x F - X - T
 * Damping: the rate is V = v_j - v_i - w_i x b_i - w_j x b_j, and
 *   F_d = d_s V + (d_n - d_s) (n.V) n + (d_t - d_s) (n_t.V) n_t,   moments b x F_d,
 *   couples d_m along n_m on w_j - w_i
 * Shear has two constants: k_t along n_t, which is the body's z axis (of links along z: x), and k_s
 * along the third axis. The terms of k_t and d_t are left out if the two are equal in all links of
 * a body (has_two_shears).
 * The net moment of a link is zero. Its damping takes the power V.F_d + W.T_d >= 0,
 * W = w_j - w_i.
 *
 * Pressure of elements
 * --------------------
 * An element of a solid with nu > 0 has the energy
 *   V (lambda' S^2 / 2 + sum over o of b_o C_o^2 / 2),   S = sum of e / 2 + t,
 *   C_o = sum of +-g_m / 2
 * over its links, e = n.D / L, g_m = 2 n_m.r / L, m the axis across a link and o (+: m is along
 * o x a). t is the load's share (Load::face_strain), and b_o is not 0 if the body is one layer
 * thick along o (solver/reference/README.md). P and Q_o are V/2 times the derivatives of the energy
 * density by S and C_o:
 *   P = V lambda' S / 2,   Q_o = V b_o C_o / 2                                        [N m]
 * A link gets from its two elements the tension (P_i + P_j) / L along n and the moments
 * +-(Q_oi + Q_oj) / L about n_m. In F, X and T they are added to (k_n - k_s) (n.D) and to
 * 2 (k_m - k_z) (n_m.r). */

/* P, and Q about the body's axes, of an element; or the strains of which they are sums. */
typedef struct {
  REAL s, x, y, z;
} pressure;

/* What the pressures of its two elements add to a link: tension along n [N], moments about n_x, n_y
 * and n_z [N m]; the one about n itself is 0. */
typedef struct {
  REAL tension, x, y, z;
} link_pressure;

typedef struct {
  REAL edge_i, edge_j;                   /* along the link [m] */
  REAL k_s, k_ns, k_ts, d_s, d_ns, d_ts; /* shear; normal, and k_t, minus it [N/m], [N s/m] */
  /* k_z: twice the rotational constant about z; k_xz, k_yz: about x, y minus about z, twice
   * [N m/rad] */
  REAL k_z, k_xz, k_yz;
  REAL d_z, d_xz, d_yz; /* the same for damping, not doubled [N m s/rad] */
} material_law;

/* The axis of n_t. */
static inline int third_axis(const int axis) { return axis == 2 ? 0 : 2; }

static inline link_pressure no_pressure(void) {
  link_pressure p = {SPLAT(0), SPLAT(0), SPLAT(0), SPLAT(0)};
  return p;
}
/* @param is_bent  the body has elements that are one layer thick */
static inline link_pressure pressure_on_link(pressure i, pressure j, const int axis,
                                             REAL inverse_edge, const int is_bent) {
  link_pressure p = no_pressure();
  p.tension = inverse_edge * (i.s + j.s);
  if (!is_bent) return p;
  if (axis == 0) p.y = inverse_edge * (i.z + j.z), p.z = -(inverse_edge * (i.y + j.y));
  if (axis == 1) p.z = inverse_edge * (i.x + j.x), p.x = -(inverse_edge * (i.z + j.z));
  if (axis == 2) p.x = inverse_edge * (i.y + j.y), p.y = -(inverse_edge * (i.x + j.x));
  return p;
}
/* From the strain e = along and the curvatures of a link, its share in the sums of S and C_o. */
static inline pressure link_share(const int axis, REAL along, REAL x, REAL y, REAL z) {
  pressure s = {along, SPLAT(0), SPLAT(0), SPLAT(0)};
  if (axis == 0) s.y = -z, s.z = y;
  if (axis == 1) s.z = -x, s.x = z;
  if (axis == 2) s.x = -y, s.y = x;
  return s;
}

/* D of the link from i to j. turn: (A - I) c of both. */
static inline vec gap_of(vec u_i, vec u_j, vec turn_i, vec turn_j) {
  return vec_sub(vec_sub(u_j, u_i), vec_add(turn_i, turn_j));
}

#ifdef LINEAR

/* Share of a link in the strains of either of its elements: e and g_m / 2.
 * @param is_bent  as in pressure_on_link */
static inline pressure link_strain(element i, element j, const int axis, REAL edge,
                                   REAL inverse_edge, const int is_bent) {
  vec gap = gap_of(i.u, j.u, rotor_turn(i.q, axis, edge), rotor_turn(j.q, axis, edge));
  REAL along = inverse_edge * vec_component(gap, axis);
  if (!is_bent) return link_share(axis, along, SPLAT(0), SPLAT(0), SPLAT(0));
  spin r = spin_scale(inverse_edge, rotor_relative(i.q, j.q));
  return link_share(axis, along, spin_component(r, 0), spin_component(r, 1), spin_component(r, 2));
}

/* Exchange of the material law (parameters as in the other version below), to first order in
 * displacements and rotations about rest: directions are the axes of the frame,
 * b = a = c, and X = 0. With constants along the principal axes
 *   F = k_s D + (k_n - k_s) (e.D) e + (k_t - k_s) (e_t.D) e_t,   T = 2 (k_x r_x, k_y r_y, k_z r_z)
 * and the same for damping with V and w_j - w_i. */
static inline exchange material_link(element i, element j, const int axis, material_law law,
                                     link_pressure pressure, const int is_damped,
                                     const int has_two_shears, const int has_pressure) {
  exchange x;
  vec gap = gap_of(i.u, j.u, rotor_turn(i.q, axis, law.edge_i), rotor_turn(j.q, axis, law.edge_j));
  spin couple = spin_principal(rotor_relative(i.q, j.q), law.k_z, law.k_xz, law.k_yz);
  x.force = vec_principal(gap, axis, law.k_s, law.k_ns);
  if (has_two_shears) x.force = vec_axpy_along(law.k_ts, gap, third_axis(axis), x.force);
  if (has_pressure) {
    x.force = vec_along(x.force, axis, pressure.tension);
    if (has_two_shears && axis != 0) couple = spin_along(couple, 0, pressure.x);
    if (has_two_shears && axis != 1) couple = spin_along(couple, 1, pressure.y);
    if (has_two_shears && axis != 2) couple = spin_along(couple, 2, pressure.z);
  }
  if (is_damped) {
    REAL half_i = SPLAT(0.5) * law.edge_i, half_j = SPLAT(0.5) * law.edge_j;
    vec v_i = lever_rate(i.w, lever_of(i.u, axis, half_i), axis, i.v);
    vec turning_j = lever_rate(j.w, lever_of(j.u, axis, half_j), axis, v_i);
    vec rate = vec_sub(j.v, turning_j);
    x.force = vec_add(x.force, vec_principal(rate, axis, law.d_s, law.d_ns));
    if (has_two_shears) x.force = vec_axpy_along(law.d_ts, rate, third_axis(axis), x.force);
    couple = spin_add(couple, spin_principal(spin_sub(j.w, i.w), law.d_z, law.d_xz, law.d_yz));
  }
  x.couple_i = couple;
  x.couple_j = spin_scale(SPLAT(-1), couple);
  return x;
}

#else

static inline vec half_sum(vec a, vec b) { return vec_scale(SPLAT(0.5), vec_add(a, b)); }

/* Adds the part of T that belongs to the body axis m:
 *   t + kr [p0 n_m + r x (n_mi - n_mj) / 2],   kr = 2 (k_m - k_z) (n_m.r) */
static inline spin turn_about(spin r, REAL p0, vec ni, vec nj, vec n, REAL kr, spin t) {
  t = spin_about(kr * p0, n, t);
  return spin_turn(spin_scale(SPLAT(0.5) * kr, r), vec_sub(ni, nj), t);
}
/* @param moment  of pressures about n_m, if the link has one */
static inline spin bend_about(spin r, REAL p0, vec ni, vec nj, REAL k, const int has_moment,
                              REAL moment, spin t) {
  vec n = half_sum(ni, nj);
  REAL kr = has_moment ? FMA(k, spin_dot(r, n), moment) : k * spin_dot(r, n);
  return turn_about(r, p0, ni, nj, n, kr, t);
}

static inline pressure link_strain(element i, element j, const int axis, REAL edge,
                                   REAL inverse_edge, const int is_bent) {
  vec n = half_sum(rotor_column(i.q, axis), rotor_column(j.q, axis));
  vec gap = gap_of(i.u, j.u, rotor_turn(i.q, axis, edge), rotor_turn(j.q, axis, edge));
  REAL along = inverse_edge * vec_dot(n, gap);
  if (!is_bent) return link_share(axis, along, SPLAT(0), SPLAT(0), SPLAT(0));
  spin r = spin_scale(inverse_edge, rotor_relative(i.q, j.q));
  REAL x = spin_dot(r, half_sum(rotor_column(i.q, 0), rotor_column(j.q, 0))),
       y = spin_dot(r, half_sum(rotor_column(i.q, 1), rotor_column(j.q, 1)));
#ifdef PLANAR
  REAL z = spin_component(r, 2);
#else
  REAL z = spin_dot(r, half_sum(rotor_column(i.q, 2), rotor_column(j.q, 2)));
#endif
  return link_share(axis, along, x, y, z);
}

/* Exchange of the material law for one pair of elements.
 * @param i, j  the elements, global frame; the + face of i is linked to the - face of j
 * @return force on i [N]; couples on i and on j [N m], to which the caller adds arm x force
 * No errors: any finite input is valid. */
static inline exchange material_link(element i, element j, const int axis, material_law law,
                                     link_pressure pressure, const int is_damped,
                                     const int has_two_shears, const int has_pressure) {
  exchange x;
  const int is_bent = has_pressure && has_two_shears;
  vec turn_i = rotor_turn(i.q, axis, law.edge_i), turn_j = rotor_turn(j.q, axis, law.edge_j);
  vec gap = gap_of(i.u, j.u, turn_i, turn_j);
  vec ni = rotor_column(i.q, axis), nj = rotor_column(j.q, axis), n = half_sum(ni, nj);
  REAL stretch =
      has_pressure ? FMA(law.k_ns, vec_dot(n, gap), pressure.tension) : law.k_ns * vec_dot(n, gap);
  vec xi = rotor_column(i.q, 0), xj = rotor_column(j.q, 0), yi = rotor_column(i.q, 1),
      yj = rotor_column(j.q, 1);
  spin r = rotor_relative(i.q, j.q), couple = spin_scale(law.k_z, r);
  REAL p0 = rotor_relative_s(i.q, j.q) + SPLAT(1);
  x.force = vec_axpy(stretch, n, vec_scale(law.k_s, gap));
  couple = bend_about(r, p0, xi, xj, law.k_xz, is_bent && axis != 0, pressure.x, couple);
  couple = bend_about(r, p0, yi, yj, law.k_yz, is_bent && axis != 1, pressure.y, couple);
  couple = vec_moment(vec_scale(SPLAT(0.25) * stretch, gap), vec_sub(ni, nj), couple);
#ifndef PLANAR
  if (is_bent && axis != 2) {
    vec zi = rotor_column(i.q, 2), zj = rotor_column(j.q, 2);
    couple = turn_about(r, p0, zi, zj, half_sum(zi, zj), pressure.z, couple);
  }
  vec t = n;
  if (has_two_shears) {
    vec ti = rotor_column(i.q, third_axis(axis)), tj = rotor_column(j.q, third_axis(axis));
    t = half_sum(ti, tj);
    REAL slide = law.k_ts * vec_dot(t, gap);
    x.force = vec_axpy(slide, t, x.force);
    couple = vec_moment(vec_scale(SPLAT(0.25) * slide, gap), vec_sub(ti, tj), couple);
  }
#endif
  if (is_damped) {
    vec bi = vec_axpy(SPLAT(0.5), gap, vec_along(turn_i, axis, SPLAT(0.5) * law.edge_i));
    vec bj = vec_axpy(SPLAT(0.5), gap, vec_along(turn_j, axis, SPLAT(0.5) * law.edge_j));
    vec rate = vec_sub(vec_sub(vec_sub(j.v, i.v), spin_cross(i.w, bi)), spin_cross(j.w, bj));
    spin turn_rate = spin_sub(j.w, i.w);
    vec nx = half_sum(xi, xj), ny = half_sum(yi, yj);
    x.force = vec_axpy(law.d_s, rate, x.force);
    x.force = vec_axpy(law.d_ns * vec_dot(n, rate), n, x.force);
#ifndef PLANAR
    if (has_two_shears) x.force = vec_axpy(law.d_ts * vec_dot(t, rate), t, x.force);
#endif
    couple = spin_axpy(law.d_z, turn_rate, couple);
    couple = spin_about(law.d_xz * spin_dot(turn_rate, nx), nx, couple);
    couple = spin_about(law.d_yz * spin_dot(turn_rate, ny), ny, couple);
  }
  /* b x F = a x F + D x F / 2. The caller adds a x F with the arms. D x F / 2 is the same on both
   * elements and is added here. */
  x.couple_i = vec_moment(vec_scale(SPLAT(0.5), gap), x.force, couple);
  x.couple_j = vec_moment(vec_scale(SPLAT(0.5), gap), x.force, spin_scale(SPLAT(-1), couple));
  return x;
}

#endif

/* Exchange of the paper's law for one pair of elements, for links outside the grid.
 * @param i, j          the elements; the + face of i is linked to the - face of j
 * @param law_i, law_j  the same k, d, kt, dt; edges of each element's own body
 * @return force [m] and couples [m^2], in units of k
 * No errors: any finite input is valid. */
static inline exchange paper_link(element i, element j, const int axis, paper_law law_i,
                                  paper_law law_j, const int is_bending, const int is_damped) {
  exchange x;
  vec upper_i =
      upper_face(centre_pull(i, law_i, is_damped), element_face(i, axis, law_i, is_damped));
  vec lower_j =
      lower_face(centre_pull(j, law_j, is_damped), element_face(j, axis, law_j, is_damped));
  x.force = vec_sub(lower_j, upper_i);
  x.couple_i = couple_moment(paper_couple(i.q, i.w, j.q, j.w, law_i, is_bending, is_damped), law_i,
                             is_bending, spin_zero());
  x.couple_j = spin_scale(SPLAT(-1), x.couple_i);
  return x;
}
