/* Stress of an element from the forces of its links, in the shared subset (spatial algebra).
 * Mean stress of a body under forces F_f at points a_f: sigma = (1 / V) sym sum_f a_f (x) F_f (virial theorem, no body
 * forces). An axis has its upper link at +a with force F_up on the element and its lower link at -a with -F_low, so it
 * adds a (x) (F_up + F_low); a face without a link is free of traction. */

typedef struct {
  REAL xx, yy, zz, yz, xz, xy;
} stress_tensor; /* [Pa], global axes */

static inline stress_tensor stress_add(stress_tensor s, vec arm, vec forces) {
  stress_tensor r = {FMA(arm.x, forces.x, s.xx),
                     FMA(arm.y, forces.y, s.yy),
                     FMA(arm.z, forces.z, s.zz),
                     FMA(SPLAT(0.5), FMA(arm.y, forces.z, arm.z * forces.y), s.yz),
                     FMA(SPLAT(0.5), FMA(arm.x, forces.z, arm.z * forces.x), s.xz),
                     FMA(SPLAT(0.5), FMA(arm.x, forces.y, arm.y * forces.x), s.xy)};
  return r;
}
/* Square of the von Mises stress: 1/2 [(xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2] + 3 (yz^2 + xz^2 + xy^2) */
static inline REAL von_mises_squared(stress_tensor s) {
  REAL a = s.xx - s.yy, b = s.yy - s.zz, c = s.zz - s.xx;
  return FMA(SPLAT(0.5), FMA(a, a, FMA(b, b, c * c)), SPLAT(3) * FMA(s.yz, s.yz, FMA(s.xz, s.xz, s.xy * s.xy)));
}
