/* All tables, as kernels pass them on. `step`: with a method with an error stage the length of the
 * step [s], else 1. */
typedef struct {
  global NUMBER* arena;
  global const row_stage* tasks;
  global const body_constants* bodies;
  global const pack_masks* masks;
  global const applied_row* applied;
  global const pattern* patterns;
  global const ushort* free_lanes;
  global const link_lanes* links;
  /* of each pack, in the order of `masks`, its upper faces across x, y, z in `links`, then its
   * lower ones */
  global const int* link_index;
  global const pressure_lanes* pressures;
  global const int* pressure_index; /* of each pack, in the order of `masks` */
  global const applied_row* face_strains;
  NUMBER step;
  int item; /* x of the element that a work-item computes */
} device;
#define TABLES                                                                                     \
  global NUMBER *arena, global const row_stage *restrict tasks,                                    \
      global const body_constants *restrict bodies, global const pack_masks *restrict masks,       \
      global const applied_row *restrict applied, global const pattern *restrict patterns,         \
      global const ushort *restrict free_lanes, global const link_lanes *restrict links,           \
      global const int *restrict link_index, global const pressure_lanes *restrict pressures,      \
      global const int *restrict pressure_index, global const applied_row *restrict face_strains,  \
      const NUMBER step_length
#define DEVICE                                                                                     \
  {                                                                                                \
    arena, tasks, bodies, masks, applied, patterns, free_lanes, links, link_index, pressures,      \
        pressure_index, face_strains, step_length, ITEM                                            \
  }

/* A row of a device, in the words of kernels/rk_update/row_update.h. */
typedef struct {
  global NUMBER* arena;
  global const row_stage* task;
} device_row;
#define ROW device_row
#define TASK(row) ((row).task)
#define PLACE(row, p) ((row).arena + (p))
/* HAS(action) is constant: whether rows of this program have the action. */
#define IF_ACTION(k, a) if (HAS(a) && (k).action == (a))
