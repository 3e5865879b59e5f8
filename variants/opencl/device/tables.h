/* Tables that the host fills and kernels read, in the same text for both. NUMBER: float or double.
 * Offsets count numbers from the start of the arena; -1: none. */

typedef struct {
#include "kernels/stage_row/body_constants.h"
} body_constants;

/* One row of one stage. */
typedef struct {
  long in, upper_y, upper_z;
  long carry_y, carry_z, from_y, from_z; /* for vectors: carry buffers */
  long lower_y, lower_z;                 /* for items: input of the lower rows */
  long base, out, increment[10];
  long published;      /* where the new state is also stored */
  long rest;           /* as in RowTask */
  long inverse_ratios; /* as in RowTask; -1: none */
  /* action: of enum row_action; shape: of the compiled terms; applied: row, -1 for most rows */
  int action, shape, body, applied;
  int face_strains; /* as applied: loads' shares in pressures */
  int packs, first_pack, masks, fields, row;
  int state_fields; /* of the fields, those without pressures, which are of another state */
  int sweep;        /* of a pass */
  int is_last, low, increments; /* as in RowTask */
  NUMBER beta, alpha[10];
} row_stage;

/* As Applied::Pattern and Applied (kernels/stage_row/row.hpp). */
typedef struct {
  long values;
  int signal, first, packs;
} pattern;
typedef struct {
  /* patterns, free_lanes: indices in their tables; -1: none */
  int first, packs, patterns, pattern_count, free_lanes;
} applied_row;

/* Lane masks of a pack: those of PackMasks, and the lanes of own elements. */
typedef struct {
  ushort link_x, link_y, link_z, below_y, below_z, own;
} pack_masks;

/* The constants of a pack's links across one face, if the links of a body differ. The host fills
 * numbers in this order. */
#ifdef W
typedef struct {
  NUMBER lane[W];
} lane_numbers;
typedef struct {
#define CONSTANT lane_numbers
#include "kernels/stage_row/link_constants.h"
#undef CONSTANT
} link_lanes;
/* As PressureConstants. */
typedef struct {
  lane_numbers s, x, y, z;
} pressure_lanes;
#endif

/* An extra link: the places of both elements and of their wrenches. */
typedef struct {
  /* lane_i, lane_j: offset of the first field from the start of the row */
  int is_material, axis, row_i, row_j, lane_i, lane_j;
  long wrench_i, wrench_j;
  NUMBER edge_i, edge_j, unit;
  body_constants body;
} extra_link;
