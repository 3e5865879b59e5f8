/* The laws of motion over the operations of an algebra, which comes before. The order counts. */
// clang-format off
#include "kernels/link_force/link_force.h"
#include "kernels/motion/motion.h"
#include "kernels/wrench/wrench.h"
#include "kernels/rk_update/rk_update.h"
// clang-format on
