/* Stress of an element from the forces of its links (shared subset, spatial algebra).
 * A body under forces F_f at points a_f has the mean stress
 *   sigma = (1 / V) sym sum_f a_f (x) F_f    (virial theorem, no body forces)
 * On one axis the upper link acts with F_up at +a and the lower link with -F_low at -a. Together
 * they add a (x) (F_up + F_low). A face without a link has no traction. */

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
/* Square of the von Mises stress [Pa^2]:
 *   1/2 [(xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2] + 3 (yz^2 + xz^2 + xy^2) */
static inline REAL von_mises_squared(stress_tensor s) {
  REAL a = s.xx - s.yy, b = s.yy - s.zz, c = s.zz - s.xx;
  return FMA(SPLAT(0.5), FMA(a, a, FMA(b, b, c * c)),
             SPLAT(3) * FMA(s.yz, s.yz, FMA(s.xz, s.xz, s.xy * s.xy)));
}
