/* Constants of a body as the laws need them (kernels/link_force/link_force.h,
 * kernels/motion/motion.h): members of a struct in C++ and in OpenCL C. NUMBER is float or double.
 * The row kernel computes forces and moments in units of `unit` newtons: k for the paper's law, 1
 * for the material law. Masses and ties are scaled to match. */
NUMBER edge[3], half_edge[3]; /* half: a product in the row would cost a register */
NUMBER edge_ratio;            /* edge along y over edge along x */
NUMBER inverse_edge[3];       /* pressure of elements */
NUMBER inverse_unit;          /* 1 / unit */
NUMBER tau, kt2, dt;          /* paper's law */
#define CONSTANT NUMBER
struct {
#include "kernels/stage_row/link_constants.h"
} axis[3]; /* material law: of links of the kind 0 */
#undef CONSTANT
NUMBER mass, inverse_mass, inertia[3], inverse_inertia[3];
NUMBER tie_k, tie_d, tie_k2_rot, tie_d_rot; /* stabilization */
int is_accelerated; /* true if gravity or base acceleration acts, or the frame rotates */
int frame_signal;   /* which signals are the frame's rate, then its change; 0: it does not rotate */
