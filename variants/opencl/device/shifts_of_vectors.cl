/* Shifts the lanes of tuples of packs by one: to those of the next element in +x (from above), or
 * in -x (from below). */
#define FROM_ABOVE(c) r.c = SHIFT_DOWN(a.c, b.c);
#define FROM_BELOW(c) r.c = SHIFT_UP(a.c, b.c);
#define SHIFTED(name, tuple, components, shift) \
  static inline tuple name(tuple a, tuple b) {  \
    tuple r;                                    \
    components(shift) return r;                 \
  }
SHIFTED(vec_from_above, vec, COMPONENTS_OF_VEC, FROM_ABOVE)
SHIFTED(vec_from_below, vec, COMPONENTS_OF_VEC, FROM_BELOW)
SHIFTED(spin_from_above, spin, COMPONENTS_OF_SPIN, FROM_ABOVE)
SHIFTED(spin_from_below, spin, COMPONENTS_OF_SPIN, FROM_BELOW)
SHIFTED(rotor_from_above, rotor, COMPONENTS_OF_ROTOR, FROM_ABOVE)
