/* All tables, as kernels hand them on. */
typedef struct {
  global NUMBER* arena;
  global const row_stage* tasks;
  global const body_constants* bodies;
  global const pack_masks* masks;
  global const applied_row* applied;
  global const pattern* patterns;
  global const ushort* free_lanes;
} device;
#define TABLES                                                                                                         \
  global NUMBER *arena, global const row_stage *tasks, global const body_constants *bodies,                            \
      global const pack_masks *masks, global const applied_row *applied, global const pattern *patterns,               \
      global const ushort *free_lanes
#define DEVICE                                                                                                         \
  { arena, tasks, bodies, masks, applied, patterns, free_lanes }
