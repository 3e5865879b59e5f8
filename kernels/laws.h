/* The laws of motion, in the operations of the algebra that the includer has included before. The
 * order of these includes matters. */
// clang-format off
#include "kernels/link_force/link_force.h"
#include "kernels/motion/motion.h"
#include "kernels/wrench/wrench.h"
#include "kernels/rk_update/rk_update.h"
// clang-format on
