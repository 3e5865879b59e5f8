/* Link laws of DESIGN.md section 2 in the shared subset, over the operations of an algebra (kernels/algebra).
 * All quantities are in the global frame and in SI units; `axis` and the flags are constants at every call and fold
 * away. */

typedef struct {
  vec u, v;
  rotor q;
  spin w;
} element; /* the fields in the order in which they are stored */

/* The link between element i and its neighbour j across i's upper face exchanges
 *   on i: force, arm_i x force + couple_i       on j: -force, arm_j x force + couple_j. */
typedef struct {
  vec force;
  spin couple_i, couple_j;
} exchange;

/* Paper's law
 * -----------
 * It is isotropic, so the force k D + d V is a difference of one quantity, k (x + tau x') with tau = d / k, at the two
 * face points that the link joins:
 *   upper face of i:  x = u + (A - I) c,  x' = v + w x a,  a = A c
 *   lower face of j:  x = u - (A - I) c,  x' = v - w x a
 *   F = k (lower_j - upper_i)
 * An element's two faces on an axis differ by one sign, and need one cross product for both moments. Forces and couples
 * are in units of k (so forces are lengths): k meets the mass and the inertia in the constants, never in the loop. */

typedef struct {
  REAL edge, half_edge, tau, kt2, dt;
} paper_law; /* [m], [m]; d / k [s]; 2 kt / k [m^2]; dt / k [m^2 s] */
typedef struct {
  lever arm;
  vec swing;
} face; /* a = A c; (A - I) c + tau w x a, by which x + tau x' of the face points differs from the centre's [m] */

/* u + tau v, common to all faces of an element, and tau w */
static inline vec centre_pull(element e, paper_law law, const int is_damped) {
  return is_damped ? vec_axpy(law.tau, e.v, e.u) : e.u;
}
static inline lever face_arm(rotor q, const int axis, REAL edge, REAL half_edge) {
  return lever_of(rotor_turn(q, axis, edge), axis, half_edge);
}
static inline face element_face(element e, const int axis, paper_law law, const int is_damped) {
  face f;
  f.swing = rotor_turn(e.q, axis, law.edge);
  f.arm = lever_of(f.swing, axis, law.half_edge);
  if (is_damped) f.swing = lever_rate(spin_scale(law.tau, e.w), f.arm, axis, f.swing);
  return f;
}
static inline vec lower_face(vec pull, face f) { return vec_sub(pull, f.swing); }
static inline vec upper_face(vec pull, face f) { return vec_add(pull, f.swing); }
/* Couple T / k = 2 kt / k r + dt / k (w_j - w_i) on i, its negative on j. Without bending it is left as w_j - w_i, for
 * the element's sum of couples to be scaled once: couple_moment. */
static inline spin paper_couple(rotor qi, spin wi, rotor qj, spin wj, paper_law law, const int is_bending,
                                const int is_damped) {
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
 * With n_m = (A_i e_m + A_j e_m) / 2 for the body axes m (n: the link's own), p = q_j conj(q_i) = (p0, r), and the common
 * point b = a + D / 2, the elastic energy is
 *   U = k_s |D|^2 / 2 + (k_n - k_s) (n.D)^2 / 2 + 4 k_z (1 - p0) + 2 (k_x - k_z) (n_x.r)^2 + 2 (k_y - k_z) (n_y.r)^2.
 * Its virtual work gives
 *   F = k_s D + (k_n - k_s) (n.D) n
 *   X = (k_n - k_s) (n.D) D x (n_i - n_j) / 4
 *   T = 2 k_z r + sum over x, y of 2 (k_m - k_z) (n_m.r) [p0 n_m + r x (n_mi - n_mj) / 2]
 *   moment on i: b_i x F + X + T,   on j: b_j x F - X - T.
 * Damping: F_d = d_s V + (d_n - d_s) (n.V) n with V = v_j - v_i - w_i x b_i - w_j x b_j, moments b x F_d; couples d_m along
 * n_m on w_j - w_i. A link exchanges no net moment, and its damping takes the power V.F_d + W.T_d >= 0. */

typedef struct {
  REAL edge_i, edge_j;       /* along the link [m] */
  REAL k_s, k_ns, d_s, d_ns; /* shear; normal minus shear [N/m], [N s/m] */
  REAL k_z, k_xz, k_yz;      /* twice the rotational constants about z; about x minus z; about y minus z [N m/rad] */
  REAL d_z, d_xz, d_yz;      /* likewise for damping, not doubled [N m s/rad] */
} material_law;

#ifdef LINEAR

/* To first order in displacements and rotations, about rest: directions are the axes of the frame, b = a = c, and X = 0. With constants
 * along the principal axes,
 *   F = k_s D + (k_n - k_s) (e.D) e,   T = 2 (k_x r_x, k_y r_y, k_z r_z),   likewise for damping with V and w_j - w_i. */
static inline exchange material_link(element i, element j, const int axis, material_law law, const int is_damped) {
  exchange x;
  vec gap = vec_sub(vec_sub(j.u, i.u), vec_add(rotor_turn(i.q, axis, law.edge_i), rotor_turn(j.q, axis, law.edge_j)));
  spin couple = spin_principal(rotor_relative(i.q, j.q), law.k_z, law.k_xz, law.k_yz);
  x.force = vec_principal(gap, axis, law.k_s, law.k_ns);
  if (is_damped) {
    REAL half_i = SPLAT(0.5) * law.edge_i, half_j = SPLAT(0.5) * law.edge_j;
    vec v_i = lever_rate(i.w, lever_of(i.u, axis, half_i), axis, i.v);
    vec turning_j = lever_rate(j.w, lever_of(j.u, axis, half_j), axis, v_i);
    x.force = vec_add(x.force, vec_principal(vec_sub(j.v, turning_j), axis, law.d_s, law.d_ns));
    couple = spin_add(couple, spin_principal(spin_sub(j.w, i.w), law.d_z, law.d_xz, law.d_yz));
  }
  x.couple_i = couple;
  x.couple_j = spin_scale(SPLAT(-1), couple);
  return x;
}

#else

static inline vec half_sum(vec a, vec b) { return vec_scale(SPLAT(0.5), vec_add(a, b)); }

/* The part of T that belongs to body axis m: t + kr [p0 n_m + r x (n_mi - n_mj) / 2], kr = 2 (k_m - k_z) (n_m.r) */
static inline spin bend_about(spin r, REAL p0, vec ni, vec nj, REAL k, spin t) {
  vec n = half_sum(ni, nj);
  REAL kr = k * spin_dot(r, n);
  t = spin_about(kr * p0, n, t);
  return spin_turn(spin_scale(SPLAT(0.5) * kr, r), vec_sub(ni, nj), t);
}

static inline exchange material_link(element i, element j, const int axis, material_law law, const int is_damped) {
  exchange x;
  vec turn_i = rotor_turn(i.q, axis, law.edge_i), turn_j = rotor_turn(j.q, axis, law.edge_j);
  vec gap = vec_sub(vec_sub(j.u, i.u), vec_add(turn_i, turn_j));
  vec ni = rotor_column(i.q, axis), nj = rotor_column(j.q, axis), n = half_sum(ni, nj);
  REAL stretch = law.k_ns * vec_dot(n, gap);
  vec xi = rotor_column(i.q, 0), xj = rotor_column(j.q, 0), yi = rotor_column(i.q, 1), yj = rotor_column(j.q, 1);
  spin r = rotor_relative(i.q, j.q), couple = spin_scale(law.k_z, r);
  REAL p0 = rotor_relative_s(i.q, j.q) + SPLAT(1);
  x.force = vec_axpy(stretch, n, vec_scale(law.k_s, gap));
  couple = bend_about(r, p0, xi, xj, law.k_xz, couple);
  couple = bend_about(r, p0, yi, yj, law.k_yz, couple);
  couple = vec_moment(vec_scale(SPLAT(0.25) * stretch, gap), vec_sub(ni, nj), couple);
  if (is_damped) {
    vec bi = vec_axpy(SPLAT(0.5), gap, vec_along(turn_i, axis, SPLAT(0.5) * law.edge_i));
    vec bj = vec_axpy(SPLAT(0.5), gap, vec_along(turn_j, axis, SPLAT(0.5) * law.edge_j));
    vec rate = vec_sub(vec_sub(vec_sub(j.v, i.v), spin_cross(i.w, bi)), spin_cross(j.w, bj));
    spin turn_rate = spin_sub(j.w, i.w);
    vec nx = half_sum(xi, xj), ny = half_sum(yi, yj);
    x.force = vec_axpy(law.d_s, rate, x.force);
    x.force = vec_axpy(law.d_ns * vec_dot(n, rate), n, x.force);
    couple = spin_axpy(law.d_z, turn_rate, couple);
    couple = spin_about(law.d_xz * spin_dot(turn_rate, nx), nx, couple);
    couple = spin_about(law.d_yz * spin_dot(turn_rate, ny), ny, couple);
  }
  /* b x F = a x F + D x F / 2: the arms' share is added with the arms, the gap's share belongs to both elements alike
   */
  x.couple_i = vec_moment(vec_scale(SPLAT(0.5), gap), x.force, couple);
  x.couple_j = vec_moment(vec_scale(SPLAT(0.5), gap), x.force, spin_scale(SPLAT(-1), couple));
  return x;
}

#endif

/* Paper's law for one pair by itself, for links outside the grid; in units of k like the law it is given. */
static inline exchange paper_link(element i, element j, const int axis, paper_law law_i, paper_law law_j,
                                  const int is_bending, const int is_damped) {
  exchange x;
  vec upper_i = upper_face(centre_pull(i, law_i, is_damped), element_face(i, axis, law_i, is_damped));
  vec lower_j = lower_face(centre_pull(j, law_j, is_damped), element_face(j, axis, law_j, is_damped));
  x.force = vec_sub(lower_j, upper_i);
  x.couple_i =
      couple_moment(paper_couple(i.q, i.w, j.q, j.w, law_i, is_bending, is_damped), law_i, is_bending, spin_zero());
  x.couple_j = spin_scale(SPLAT(-1), x.couple_i);
  return x;
}
